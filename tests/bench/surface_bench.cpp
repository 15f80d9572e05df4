// The observed surface, by body: rows of 640 pixels, and a whole VGA picture.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/camera/surface.hpp"
#include "core/camera/surface_rows.hpp"
#include "tests/core/synthetic.hpp"

namespace pliant {
namespace {

const Intrinsics kVga{640, 480, 575, 575, 319.5, 239.5, 1000};
constexpr std::size_t kCount = 640;

/// False, and the benchmark skipped, where this CPU lacks the body.
bool available(benchmark::State& state, Kernels kernels) {
  if (kernels == Kernels::scalar || simd_body(kernels) != SimdBody::scalar) return true;
  state.SkipWithError("not on this CPU");
  return false;
}

std::vector<std::uint16_t> noisy_row(unsigned seed) {
  std::vector<std::uint16_t> row(kCount + 4 * kRowSlack);
  std::uint32_t x = seed;
  for (std::size_t i = 0; i < row.size(); ++i) {
    x = x * 1664525U + 1013904223U;
    row[i] = static_cast<std::uint16_t>(6400 + i + (x >> 28));
  }
  return row;
}

template <typename Pass>
void run_rows(benchmark::State& state, Pass pass) {
  const auto kernels = static_cast<Kernels>(state.range(0));
  if (!available(state, kernels)) return;
  const SurfaceRows& rows = surface_rows(simd_body(kernels));
  const std::vector<std::uint16_t> above = noisy_row(1), row = noisy_row(2), below = noisy_row(3);
  std::vector<std::uint16_t> out(row.size());
  for (auto _ : state) {
    pass(rows, above.data() + kRowSlack, row.data() + kRowSlack, below.data() + kRowSlack,
         out.data() + kRowSlack);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}

void convert_row(benchmark::State& state) {
  const DepthScale scale(kVga, SensorDescription());
  run_rows(state, [&](const SurfaceRows& rows, auto*, auto* row, auto*, auto* out) {
    rows.convert(row, out, kCount, scale);
  });
}

void clean_row(benchmark::State& state) {
  const DiscontinuityRule rule(kVga, SensorDescription());
  run_rows(state, [&](const SurfaceRows& rows, auto* above, auto* row, auto* below, auto* out) {
    rows.clean(above, row, below, out, kCount, rule);
  });
}

void smooth_row(benchmark::State& state) {
  const DiscontinuityRule rule(kVga, SensorDescription());
  run_rows(state, [&](const SurfaceRows& rows, auto* above, auto* row, auto* below, auto* out) {
    rows.smooth(above, row, below, out, kCount, rule);
  });
}

void build_vga(benchmark::State& state) {
  const auto kernels = static_cast<Kernels>(state.range(0));
  if (!available(state, kernels)) return;
  Workspace measure;
  Surface surface;
  surface.lay_out(measure, kVga);
  synthetic::OwnedWorkspace memory(measure.used());
  surface.lay_out(memory.get(), kVga);
  surface.start(kVga, SensorDescription(), kernels);
  synthetic::Picture picture(kVga);
  picture.draw(synthetic::bumpy_body(), synthetic::pose_at({0, 0, 0.7}, {1, 2, 3}, 0.5));
  picture.wall(1.4);
  picture.shake(0.002, 1);
  const DepthFrame frame = picture.frame();
  for (auto _ : state) surface.build(frame, {0, 0, 640, 480});
  state.SetItemsProcessed(state.iterations() * 640 * 480);
}

void every_kernel(benchmark::internal::Benchmark* b) {
  b->ArgName("kernels(1scalar,2sse,3avx2,4neon)");
  for (const Kernels k : {Kernels::scalar, Kernels::sse, Kernels::avx2, Kernels::neon})
    b->Arg(static_cast<int>(k));
}

BENCHMARK(convert_row)->Apply(every_kernel);
BENCHMARK(clean_row)->Apply(every_kernel);
BENCHMARK(smooth_row)->Apply(every_kernel);
BENCHMARK(build_vga)->Apply(every_kernel)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pliant

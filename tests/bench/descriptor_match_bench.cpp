// Dot products of a block of queries with the descriptors of a model, by body.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/detect/descriptor_match.hpp"

namespace pliant {
namespace {

void match(benchmark::State& state) {
  const auto kernels = static_cast<Kernels>(state.range(0));
  const auto count = static_cast<std::size_t>(state.range(1));
  const DotKernel kernel = dot_kernel(kernels);
  if (kernel == &dot_products_scalar && kernels != Kernels::scalar) {
    state.SkipWithError("not on this CPU");
    return;
  }
  std::vector<Descriptor> descriptors(count + kDotQueries);
  std::uint32_t x = 7;
  for (Descriptor& d : descriptors)
    for (std::int8_t& bin : d.bins) {
      x = x * 1664525U + 1013904223U;
      bin = static_cast<std::int8_t>((x >> 24) % 12);  // norms as real ones have
    }
  std::vector<std::int16_t> dots(kDotQueries * count);
  for (auto _ : state) {
    kernel(descriptors.data(), descriptors.data() + kDotQueries, count, dots.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kDotQueries * count));
}

BENCHMARK(match)
    ->ArgNames({"kernels(0auto,1scalar,2sse,3avx2,4neon)", "candidates"})
    ->ArgsProduct({{0, 1, 2, 3, 4}, {1500}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pliant

// Matching of a block of queries with the descriptors of a model, by body.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "core/detect/descriptor_match.hpp"

namespace pliant {
namespace {

void match(benchmark::State& state) {
  const auto kernels = static_cast<Kernels>(state.range(0));
  const auto count = static_cast<std::size_t>(state.range(1));
  if (dot_kernel(kernels) == &dot_products_scalar && kernels != Kernels::scalar) {
    state.SkipWithError("not on this CPU");
    return;
  }
  constexpr std::size_t kQueries = 64;
  std::vector<Descriptor> descriptors(count + kQueries);
  std::uint32_t x = 7;
  for (Descriptor& d : descriptors)
    for (std::int8_t& bin : d.bins) {
      x = x * 1664525U + 1013904223U;
      bin = static_cast<std::int8_t>((x >> 24) %
                                     12);  // norms as real ones have, but no structure: the worst case
    }
  Workspace measure;
  DescriptorMatcher matcher;
  matcher.lay_out(measure, count);
  std::vector<std::byte> memory(measure.used() + Workspace::kAlignment);
  void* at = memory.data();
  std::size_t space = memory.size();
  std::align(Workspace::kAlignment, measure.used(), at, space);
  Workspace workspace({static_cast<std::byte*>(at), measure.used()});
  matcher.lay_out(workspace, count);
  matcher.start(kernels);
  matcher.prepare(std::span(descriptors).subspan(kQueries));
  std::vector<Match> matches(kQueries);
  for (auto _ : state) {
    matcher.match(std::span(descriptors).first(kQueries), 1, matches);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kQueries * count));
}

BENCHMARK(match)
    ->ArgNames({"kernels(0auto,1scalar,2sse,3avx2,4neon)", "candidates"})
    ->ArgsProduct({{0, 1, 2, 3, 4}, {1500}})
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pliant

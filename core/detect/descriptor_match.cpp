#include "core/detect/descriptor_match.hpp"

#include <algorithm>

#include "core/simd/cpu.hpp"

namespace pliant {

DotKernel dot_kernel(Kernels kernels) noexcept {
  switch (simd_body(kernels)) {
#if defined(__x86_64__) || defined(__i386__)
    case SimdBody::avx2:
      return kernels == Kernels::automatic && cpu_features().avx512vnni ? &dot_products_avx512vnni
                                                                        : &dot_products_avx2;
    case SimdBody::sse41:
      return &dot_products_sse41;
#elif defined(__aarch64__)
    case SimdBody::neon:
      return kernels == Kernels::automatic && cpu_features().dot_products ? &dot_products_dotprod
                                                                          : &dot_products_neon;
#elif defined(__arm__)
    case SimdBody::neon:
      return &dot_products_neon;
#endif
    default:
      return &dot_products_scalar;
  }
}

void DescriptorMatcher::lay_out(Workspace& workspace, std::size_t candidates) noexcept {
  dots_ = workspace.take<std::int16_t>(kDotQueries * candidates);
  padded_ = workspace.take<Descriptor>(kDotQueries);
}

void DescriptorMatcher::match(std::span<const Descriptor> queries, std::span<const Descriptor> candidates,
                              std::size_t best, std::span<Match> matches) noexcept {
  best = std::min(std::max<std::size_t>(best, 1), kMostBest);
  const std::size_t count = std::min(candidates.size(), dots_.size() / kDotQueries);
  if (count == 0) return;
  const std::size_t most = std::min(queries.size(), matches.size() / best);
  for (std::size_t first = 0; first < most; first += kDotQueries) {
    const std::size_t group = std::min(kDotQueries, most - first);
    const Descriptor* block = queries.data() + first;
    if (group < kDotQueries) {
      for (std::size_t q = 0; q < kDotQueries; ++q) padded_[q] = queries[first + std::min(q, group - 1)];
      block = padded_.data();
    }
    kernel_(block, candidates.data(), count, dots_.data());
    for (std::size_t q = 0; q < group; ++q) {
      const std::int16_t* dots = dots_.data() + q * count;
      // One more than asked for: the runner-up behind the last. Sorted by falling dot product.
      std::int16_t top[kMostBest + 1];
      std::uint16_t index[kMostBest + 1];
      for (std::size_t k = 0; k <= best; ++k) {
        top[k] = -1;
        index[k] = 0;
      }
      for (std::size_t c = 0; c < count; ++c) {
        if (dots[c] <= top[best]) continue;
        std::size_t k = best;
        for (; k > 0 && dots[c] > top[k - 1]; --k) {
          top[k] = top[k - 1];
          index[k] = index[k - 1];
        }
        top[k] = dots[c];
        index[k] = static_cast<std::uint16_t>(c);
      }
      for (std::size_t k = 0; k < best; ++k) {
        const std::size_t from = top[k] >= 0 ? k : count - 1;
        matches[(first + q) * best + k] = {static_cast<std::uint16_t>(first + q), index[from], top[from],
                                           std::max<std::int16_t>(top[from + 1], 0)};
      }
    }
  }
}

}  // namespace pliant

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

/// The best so far by falling dot product, of equals the lowest index first.
struct DescriptorMatcher::Best {
  std::size_t wanted;
  std::int16_t dots[kMostBest];
  std::uint32_t index[kMostBest];

  explicit Best(std::size_t most) noexcept : wanted(most) {
    for (std::size_t k = 0; k < wanted; ++k) {
      dots[k] = -1;
      index[k] = UINT32_MAX;
    }
  }
  void offer(std::int16_t dot, std::uint32_t candidate) noexcept {
    const auto before = [&](std::size_t k) {
      return dot > dots[k] || (dot == dots[k] && candidate < index[k]);
    };
    if (!before(wanted - 1)) return;
    for (std::size_t k = 0; k < wanted; ++k)
      if (index[k] == candidate) return;
    std::size_t k = wanted - 1;
    for (; k > 0 && before(k - 1); --k) {
      dots[k] = dots[k - 1];
      index[k] = index[k - 1];
    }
    dots[k] = dot;
    index[k] = candidate;
  }
};

void DescriptorMatcher::lay_out(Workspace& workspace, std::size_t candidates) noexcept {
  close_.lay_out(workspace, candidates);
  lay_out_helper(workspace, candidates);
}

void DescriptorMatcher::lay_out_helper(Workspace& workspace, std::size_t candidates) noexcept {
  bounds_ = workspace.take<std::int32_t>(kBoundQueries * (candidates + kBoundLanes));
  left_ = workspace.take<std::uint32_t>(candidates + kBoundLanes);
  padded_ = workspace.take<Descriptor>(kBoundQueries);
}

void DescriptorMatcher::start(Kernels kernels) noexcept {
  kernel_ = dot_kernel(kernels);
  close_.start(kernels);
}

void DescriptorMatcher::join(const DescriptorMatcher& prepared) noexcept {
  kernel_ = prepared.kernel_;
  close_ = prepared.close_;
  candidates_ = prepared.candidates_;
}

void DescriptorMatcher::prepare(std::span<const Descriptor> candidates) noexcept {
  candidates_ = candidates.first(std::min(candidates.size(), bounds_.size() / kBoundQueries));
  close_.build(candidates_);
}

void DescriptorMatcher::compare(const Descriptor& query, std::span<const std::uint32_t> which,
                                Best& best) const noexcept {
  constexpr std::size_t kChunk = 64;
  std::int16_t dots[kChunk];
  for (std::size_t first = 0; first < which.size(); first += kChunk) {
    const std::size_t count = std::min(kChunk, which.size() - first);
    kernel_(query, candidates_.data(), which.data() + first, count, dots);
    for (std::size_t k = 0; k < count; ++k) best.offer(dots[k], which[first + k]);
  }
}

void DescriptorMatcher::match(std::span<const Descriptor> queries, std::size_t wanted,
                              std::span<Match> matches) noexcept {
  wanted = std::min(std::max<std::size_t>(wanted, 1), kMostBest);
  const std::size_t count = candidates_.size();
  if (count == 0) return;
  const std::size_t most = std::min(queries.size(), matches.size() / wanted);
  for (std::size_t first = 0; first < most; first += kBoundQueries) {
    const std::size_t group = std::min(kBoundQueries, most - first);
    const Descriptor* block = queries.data() + first;
    if (group < kBoundQueries) {
      for (std::size_t q = 0; q < kBoundQueries; ++q) padded_[q] = queries[first + std::min(q, group - 1)];
      block = padded_.data();
    }
    std::uint32_t lead[kBoundQueries * kBoundLanes];
    close_.bounds(block, bounds_.data(), lead);
    for (std::size_t q = 0; q < group; ++q) {
      const Descriptor& query = queries[first + q];
      const std::int32_t* bounds = bounds_.data() + q * close_.padded_size();
      // The candidates with the largest bounds first: they are likely the best, and leave few others.
      Best best(wanted);
      std::uint32_t* leading = lead + q * kBoundLanes;
      std::uint32_t* last =
          std::remove_if(leading, leading + kBoundLanes, [&](std::uint32_t c) { return c >= count; });
      const std::size_t leaders = std::min(static_cast<std::size_t>(last - leading), wanted + 3);
      std::partial_sort(leading, leading + leaders, last, [&](std::uint32_t a, std::uint32_t b) {
        return bounds[a] != bounds[b] ? bounds[a] > bounds[b] : a < b;
      });
      compare(query, {leading, leaders}, best);
      const std::size_t left = close_.select(bounds, best.dots[wanted - 1], left_.data());
      compare(query, left_.first(left), best);
      for (std::size_t k = 0; k < wanted; ++k) {
        const std::size_t from = best.dots[k] >= 0 ? k : count - 1;
        matches[(first + q) * wanted + k] = {static_cast<std::uint16_t>(first + q),
                                             static_cast<std::uint16_t>(best.index[from]), best.dots[from]};
      }
    }
  }
}

}  // namespace pliant

#include "firmware-app/measure/histogram.hpp"

#include <algorithm>
#include <bit>

namespace pliant {

void Histogram::add(std::int64_t nanoseconds) noexcept {
  constexpr std::int64_t kLongest = (std::int64_t{1} << kMaxBits) - 1;
  const auto value = static_cast<std::uint64_t>(std::clamp<std::int64_t>(nanoseconds, 0, kLongest));
  // Below 2^(kSubBits + 1) a bucket is one nanosecond; above, the top kSubBits + 1 bits choose it.
  const int shift = std::max(0, static_cast<int>(std::bit_width(value)) - kSubBits - 1);
  const std::size_t bucket =
      (static_cast<std::size_t>(shift) << kSubBits) + static_cast<std::size_t>(value >> shift);
  ++buckets_[bucket];
  ++count_;
  max_ = std::max(max_, static_cast<std::int64_t>(value));
}

std::int64_t Histogram::quantile(double q) const noexcept {
  if (count_ == 0) return 0;
  const auto rank = static_cast<std::uint64_t>(std::clamp(q, 0.0, 1.0) * static_cast<double>(count_ - 1));
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    seen += buckets_[bucket];
    if (seen <= rank) continue;
    constexpr std::size_t kSub = std::size_t{1} << kSubBits;
    const std::size_t shift = bucket < 2 * kSub ? 0 : (bucket >> kSubBits) - 1;
    // 64 bits on every machine: 32 would hold four seconds only.
    const std::uint64_t low = std::uint64_t{bucket - (shift << kSubBits)} << shift;
    const std::uint64_t middle = low + ((std::uint64_t{1} << shift) >> 1);
    return std::min(max_, static_cast<std::int64_t>(middle));
  }
  return max_;
}

}  // namespace pliant

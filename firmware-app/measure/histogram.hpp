// Durations in fixed memory.
#pragma once

#include <array>
#include <cstdint>

namespace pliant {

/// Counts durations in buckets whose width is 1/64 of their value: quantiles are right to 1 %, for any number
/// of values from 1 ns to 18 minutes (longer ones count as that). No heap.
class Histogram {
 public:
  void add(std::int64_t nanoseconds) noexcept;
  void clear() noexcept { *this = Histogram(); }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// The value that a share `q` (0 to 1) of all values does not exceed; 0 when there is none. Nanoseconds.
  [[nodiscard]] std::int64_t quantile(double q) const noexcept;
  [[nodiscard]] std::int64_t median() const noexcept { return quantile(0.5); }
  [[nodiscard]] std::int64_t p99() const noexcept { return quantile(0.99); }
  [[nodiscard]] std::int64_t max() const noexcept { return max_; }

 private:
  static constexpr int kSubBits = 6;  // 64 buckets an octave
  static constexpr int kMaxBits = 40;
  static constexpr std::size_t kBuckets = std::size_t{kMaxBits - kSubBits + 1} << kSubBits;

  std::array<std::uint32_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace pliant

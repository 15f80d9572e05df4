// Smooth random fields that repeat like wallpaper.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pliant::simulated {

/// A square of nearly Gaussian values, mean 0, standard deviation kDeviation, that continues into itself on
/// all sides. Its correlation is 0.45 at two pixels, 0.25 at four and 0.15 at six: what the noise of a
/// PrimeSense sensor shows, whose matching windows overlap.
class NoiseField {
 public:
  static constexpr int kDeviation = 32;

  /// `size` a power of two; the same seed gives the same field on every platform.
  NoiseField(std::uint32_t size, std::uint64_t seed);

  [[nodiscard]] int at(std::uint32_t u, std::uint32_t v) const { return row(v)[u & mask_]; }
  [[nodiscard]] const std::int8_t* row(std::uint32_t v) const {
    return values_.data() + static_cast<std::size_t>(v & mask_) * (mask_ + 1);
  }
  [[nodiscard]] std::uint32_t mask() const { return mask_; }

 private:
  std::uint32_t mask_;
  std::vector<std::int8_t> values_;
};

}  // namespace pliant::simulated

// The middle of the points of an alignment, and how far their residuals spread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "core/camera/surface.hpp"

namespace pliant {

/// Exact sums and a histogram: the order of adding does not matter. Points in 1/16 mm, residuals in 1/256 mm.
struct ResidualSpread {
  static constexpr int kBins = 512;  // of |residual|, 1/16 mm each
  std::uint32_t count = 0;
  std::int64_t x = 0, y = 0, z = 0;
  std::array<std::uint32_t, kBins> bins{};

  void add(const IntPoint& point, std::int32_t residual) noexcept {
    ++count;
    x += point.x;
    y += point.y;
    z += point.z;
    ++bins[static_cast<std::size_t>(std::min(std::abs(residual) >> 4, kBins - 1))];
  }
  /// There is a point.
  [[nodiscard]] IntPoint centre() const noexcept {
    return {static_cast<std::int32_t>(x / count), static_cast<std::int32_t>(y / count),
            static_cast<std::int32_t>(z / count)};
  }
  /// Median of |residual|, 1/16 mm, at least 1.
  [[nodiscard]] std::int32_t median() const noexcept {
    std::uint32_t below = 0;
    for (int i = 0; i < kBins; ++i) {
      below += bins[static_cast<std::size_t>(i)];
      if (2 * below >= count) return i + 1;
    }
    return kBins;
  }
};

}  // namespace pliant

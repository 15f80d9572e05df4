// Where regions meet.
#pragma once

#include <array>
#include <cstdint>

#include "core/track/patches.hpp"

namespace pliant {

/// Which regions a patch and those beside it have points of: only to these can a point of it go over.
struct RegionBorders {
  std::array<std::uint8_t, kMaxPatches> near{};  ///< one bit a region
  static_assert(limits::kMaxRegions <= 8);

  /// More than one.
  [[nodiscard]] bool has(std::size_t patch) const noexcept { return (near[patch] & (near[patch] - 1)) != 0; }
  [[nodiscard]] bool meets(std::size_t patch, std::size_t region) const noexcept {
    return (near[patch] >> region & 1) != 0;
  }
};

/// `home`: region of every model point.
[[nodiscard]] RegionBorders region_borders(const PatchTables& patches,
                                           std::span<const std::int8_t> home) noexcept;

}  // namespace pliant

// From which directions the object was seen.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/rigid_transform.hpp"
#include "core/memory/row_major.hpp"

namespace pliant {

/// Sectors of a turn about the upright axis: front (the first view), front right, right, back right, back,
/// back left, left, front left, as seen from the first view; and heights of the camera: below 20° (level),
/// below 50° (sloping), above.
class Coverage {
 public:
  static constexpr int kSectors = 8, kHeights = 3;

  void clear() noexcept { *this = Coverage(); }
  /// A view at `pose` (camera <- model, the model's z upright) was fused; it counts as `times` of them.
  void add(const RigidTransform& pose, std::uint32_t times = 1) noexcept;
  [[nodiscard]] std::uint32_t views(int sector, int height) const noexcept {
    return views_[row_major(height, kSectors, sector)];
  }
  /// Seen from there at any height, often enough to count.
  [[nodiscard]] bool seen(int sector) const noexcept;
  [[nodiscard]] int sectors_seen() const noexcept;
  /// The height from which most views came.
  [[nodiscard]] int usual_height() const noexcept;
  [[nodiscard]] bool seen_from_above() const noexcept;
  /// Views that make a direction count.
  static constexpr std::uint32_t kEnoughViews = 3;

 private:
  std::array<std::uint32_t, table_size(kSectors, kHeights)> views_{};
};

}  // namespace pliant

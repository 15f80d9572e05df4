// The planes that the object does not belong to: table, wall, floor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/camera/surface.hpp"
#include "core/memory/workspace.hpp"

namespace pliant {

/// A plane that the camera looks at: normal · p = offset, the normal towards the camera, hence offset < 0.
struct BackgroundPlane {
  IntPoint normal;           ///< unit, Q14
  std::int32_t offset = 0;   ///< 1/16 mm
  std::uint32_t points = 0;  ///< of the lattice that lie on it
  std::int32_t spread = 0;   ///< standard deviation of their heights, 1/16 mm

  /// How far `p` lies before the plane, 1/16 mm. |p| < 2^15.
  [[nodiscard]] std::int32_t height(const IntPoint& p) const noexcept {
    return ((normal.x * p.x + normal.y * p.y + normal.z * p.z + 8192) >> 14) - offset;
  }
};

class BackgroundPlanes {
 public:
  static constexpr std::size_t kMost = 4;

  void lay_out(Workspace& workspace, const Intrinsics& camera) noexcept;
  void start(const Surface& surface, double least_extent) noexcept;

  /// Follows the planes of the last picture, and looks for further ones when one was lost and every
  /// kSearchEvery pictures. Planes that reach less than `least_extent` (metres) belong to objects.
  void update(const Surface& surface) noexcept;

  [[nodiscard]] std::span<const BackgroundPlane> planes() const noexcept { return {planes_.data(), count_}; }
  /// Does a reading stand out before every plane by at least `margin` (1/16 mm) and 2.5 of the plane's own
  /// standard deviations?
  [[nodiscard]] bool stands_out(const IntPoint& p, std::int32_t margin) const noexcept {
    for (std::size_t k = 0; k < count_; ++k) {
      const std::int32_t uneven = planes_[k].spread * 5 / 2;
      if (planes_[k].height(p) < (margin > uneven ? margin : uneven)) return false;
    }
    return true;
  }

 private:
  static constexpr int kStep = 8;                 // pixels between points of the lattice
  static constexpr int kSearchEvery = 15;         // pictures
  static constexpr std::size_t kCandidates = 64;  // planes tried in a search

  struct LatticePoint {
    IntPoint p;
    std::int16_t sigma = 0;  // 1/16 mm
    std::int8_t plane = -1;  // that it lies on
    bool usable = false;
    bool visited = false;
  };
  void gather(const Surface& surface) noexcept;
  [[nodiscard]] bool lies_on(const LatticePoint& point, const BackgroundPlane& plane) const noexcept;
  /// Fits to the unassigned points near `plane`; false when it reaches too little.
  [[nodiscard]] bool fit(BackgroundPlane& plane) noexcept;
  /// The largest edge of the bounding box around points on the plane that hang together, 1/16 mm: what merely
  /// crosses the plane elsewhere does not make it large.
  [[nodiscard]] std::int32_t connected_extent(const BackgroundPlane& plane) noexcept;
  [[nodiscard]] std::uint32_t votes(const BackgroundPlane& plane) const noexcept;
  [[nodiscard]] bool search(const Surface& surface, BackgroundPlane& best) const noexcept;
  void assign(const BackgroundPlane& plane, std::int8_t index) noexcept;

  double least_extent_ = 0;
  std::array<BackgroundPlane, kMost> planes_;
  std::size_t count_ = 0;
  int age_ = 0;
  int across_ = 0, down_ = 0;  // of the lattice
  std::span<LatticePoint> lattice_;
  std::span<std::int32_t> queue_;
  std::size_t used_ = 0;  // lattice points with a reading
  std::int32_t normal_span_ = 0;
};

}  // namespace pliant

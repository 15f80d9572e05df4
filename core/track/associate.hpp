// Projective association: every model point beside the reading of the pixel it falls on.
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

/// Cosine of the steepest view that still tells something of a surface, Q14.
inline constexpr std::int32_t kCos75 = 4240;

/// Points of a region that are enough for its pose: the thousandth does not make it better than the sensor's
/// systematic errors, a tenth of σ.
inline constexpr std::size_t kEnoughOfRegion = 1500;

/// How a region's readings are looked for.
struct SearchReach {
  std::size_t points = 0;  ///< the region's are looked at of the first so many model points, a uniform
                           ///< sampling: no more than kEnoughOfRegion; 0: none
  std::int32_t gate = 0;   ///< readings farther than this from the point are not taken, 1/16 mm
};

using SearchReaches = std::array<SearchReach, limits::kMaxRegions>;

/// Fills `points.correspondences`, patch by patch. Where the camera sees through a point of a region that is
/// not the base, the nearest reading beside it pulls: a small part slides along itself otherwise. The base
/// has readings enough, and edges are noisier than surfaces. Points that face away (beyond 75° from the line
/// of sight), but for those on the outline of such a region, which follow it (contour.hpp), and those that
/// count as deformed, are left out; readings whose surface faces another way are not taken.
void associate(const ModelTables& model, const Surface& surface, const Projector& projector,
               const RegionSet& regions, const SearchReaches& reaches, PointState& points) noexcept;

/// Signed distance of `reading` from `point` along the unit `normal` (Q14) in 1/256 mm.
/// Overflow bound: |reading - point| < 2^16. So it is within a pixel of the point's ray and kFarthestReading
/// in depth: no ray goes farther aside than kMostSlope, no pixel is wider than 0.1 of the depth.
[[nodiscard]] inline std::int32_t plane_distance(const IntPoint& reading, const IntPoint& point,
                                                 const IntPoint& normal) noexcept {
  return (normal.x * (reading.x - point.x) + normal.y * (reading.y - point.y) +
          normal.z * (reading.z - point.z) + 512) >>
         10;
}

/// Does a surface at `point` with `normal` (Q14) face the camera at more than `least` (Q14, cosine)?
[[nodiscard]] inline bool faces_camera(const IntPoint& point, const IntPoint& normal,
                                       std::int32_t least) noexcept {
  // |point| is taken as its largest coordinate, z, for the wide angles of a depth camera: an error below 1.3
  const std::int32_t towards =
      -(normal.x * (point.x >> 4) + normal.y * (point.y >> 4) + normal.z * (point.z >> 4));
  return towards > 0 && towards / 16384 > ((least * (point.z >> 4)) >> 14);
}

}  // namespace pliant

// Where the object's outline has moved: what the surface cannot tell of motion along itself.
#pragma once

#include <cstdlib>

#include "core/camera/surface.hpp"
#include "core/track/model_tables.hpp"

namespace pliant {

/// How far the picture is searched for the outline; below 2^15, so that the steps fit 32 bits.
struct ContourReach {
  std::int32_t along = 0;   ///< to each side of a point, along its normal, 1/16 mm
  std::int32_t behind = 0;  ///< readings farther behind a point than this are not the object's, 1/16 mm
};

/// Cosine of the flattest view that still is an outline, Q14.
inline constexpr std::int32_t kCos80 = 2845;

/// Does the surface at `point` with `normal` (unit, Q14) turn away from the camera just there, within 10°?
/// Its point lies on the outline, but for 1.5 % of the surface's radius of curvature.
[[nodiscard]] inline bool on_rim(const IntPoint& point, const IntPoint& normal) noexcept {
  const std::int32_t towards =
      -(normal.x * (point.x >> 4) + normal.y * (point.y >> 4) + normal.z * (point.z >> 4));
  return std::abs(towards / 16384) <= ((kCos80 * (point.z >> 4)) >> 14);
}

/// How far the outline lies from such a point along its normal, 1/16 mm, positive outwards: from the point's
/// pixel outwards to the last reading of the object, or inwards to the first. What stands farther behind is
/// not the object; a few pixels without a reading are a hole in it, more are behind its edge. False when
/// there is no outline within reach, or something nearer, its shadow, or the end of the picture, hides it. An
/// integer kernel. Overflow bounds: the normal as the picture shows it is below 2^16 in Q14, times 256 below
/// 2^24; lengths are taken in 64 bits; at most 44 steps each way.
[[nodiscard]] bool find_contour(const Surface& surface, const Projector& projector, const ContourReach& reach,
                                const IntPoint& point, const IntPoint& normal,
                                std::int32_t& distance) noexcept;

}  // namespace pliant

// The rows of a point-to-plane alignment in the model's frame, and the robust sums over them.
#pragma once

#include <cstdint>
#include <span>

#include "core/camera/surface.hpp"
#include "core/fixed/moments.hpp"

namespace pliant {

struct PlaneRow {
  IntPoint point;           ///< model frame, 1/16 mm
  std::int16_t nx, ny, nz;  ///< of the plane, unit, model frame, Q14
  std::int16_t vx, vy, vz;  ///< the view's own normal at the point, likewise
  std::int32_t residual;    ///< distance of the plane from the point along the normal, 1/256 mm
};

/// `normal` of the plane, `own` of the view: as they are computed, in Q14.
[[nodiscard]] inline PlaneRow plane_row(const IntPoint& point, const IntPoint& normal, const IntPoint& own,
                                        std::int32_t residual) noexcept {
  return {point,
          static_cast<std::int16_t>(normal.x),
          static_cast<std::int16_t>(normal.y),
          static_cast<std::int16_t>(normal.z),
          static_cast<std::int16_t>(own.x),
          static_cast<std::int16_t>(own.y),
          static_cast<std::int16_t>(own.z),
          residual};
}

struct RobustMoments {
  PlaneMoments moments;    ///< about `centre`
  IntPoint centre;         ///< 1/16 mm
  std::int32_t limit = 0;  ///< of Tukey's weights, 1/256 mm
  std::int32_t scale = 0;  ///< 1.4826 times the median of |residual|, at least half of the noise, 1/16 mm
};

/// Tukey's weights at a scale from the median, never narrower than at `noise`/3 (1/16 mm), which smoothing
/// leaves of a reading's σ. No rows: moments.rows is 0.
[[nodiscard]] RobustMoments robust_moments(std::span<const PlaneRow> rows, std::int32_t noise) noexcept;
/// The same about a given centre.
[[nodiscard]] RobustMoments robust_moments(std::span<const PlaneRow> rows, std::int32_t noise,
                                           const IntPoint& centre) noexcept;

}  // namespace pliant

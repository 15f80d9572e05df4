// How far the surface is off the model where the object is not deformed: what a worn, coarse or padded model
// does not tell.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/track/track_state.hpp"

namespace pliant {

/// What of a point's misfit (PointState::misfit, 1/256 mm) is the model's own error, along its normal, in
/// 1/16 mm: nothing below `noise` (Tolerance::smoothed_noise, 1/16 mm), which tells no place from another,
/// from twice that on all of it, and in between what joins the two. At most `limit`, the inlier test's.
[[nodiscard]] inline std::int32_t model_error(std::int32_t misfit, std::int32_t noise,
                                              std::int32_t limit) noexcept {
  const std::int32_t size = misfit < 0 ? -misfit : misfit, least = noise * 16;
  if (size <= least) return 0;
  const std::int32_t error = std::min(std::min(size, 2 * (size - least)) >> 4, limit);
  return misfit < 0 ? -error : error;
}

/// The point where the surface is: `length` (1/16 mm, below 2^15) along its normal (Q14).
[[nodiscard]] inline IntPoint moved_along(const IntPoint& point, const IntPoint& normal,
                                          std::int32_t length) noexcept {
  return {point.x + ((normal.x * length + 8192) >> 14), point.y + ((normal.y * length + 8192) >> 14),
          point.z + ((normal.z * length + 8192) >> 14)};
}

}  // namespace pliant

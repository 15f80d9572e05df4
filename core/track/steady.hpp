// What stands still is held still: noise alone moves nothing.
#pragma once

#include <algorithm>

#include "core/track/track_state.hpp"

namespace pliant {

/// How much of the sensor's σ is left in a pose from many readings.
inline constexpr double kNoiseOfPose = 0.5;

/// What a region's readings are spread by, 1/16 mm: the sensor's σ, `sigma`, or, where the model is off the
/// object by more, `scale` (TrackedRegion::scale), since noise then decides which of them weigh how much. At
/// most the 4 σ of the inlier test.
[[nodiscard]] constexpr std::int32_t spread_of_readings(std::int32_t sigma, std::int32_t scale) noexcept {
  return std::clamp(scale, sigma, 4 * sigma);
}

/// The part of the motion from `before` to `after` that noise does not explain: a share s² / (s² + n²) of it,
/// s being how far it moves a body of radius 2 · `half_radius` about `centre` (model frame, metres) in the
/// root mean square. n is three times `noise` for this step alone, beyond what noise reaches, and `noise` for
/// the mean of the last steps; the larger share counts, and no less than `least`. Of a body that has been at
/// rest for some frames n is twice that. Lags by no more than the noise behind steady motion, by twice that
/// in its first second.
[[nodiscard]] RigidTransform steadied(const RigidTransform& before, const RigidTransform& after,
                                      const Vector3& centre, double half_radius, double noise,
                                      StepMemory& memory, double least = 0) noexcept;

/// The least share of a motion that counts in the first frames after the object was taken up: as in a mean
/// over them, since the place that it was taken up in is a coarse one. `frames` as in PointState.
[[nodiscard]] constexpr double least_share(std::int32_t frames) noexcept {
  return frames < 1 ? 1.0 : frames <= kMisfitFirstFrames ? 1.0 / frames : 0.0;
}

/// Steadies every region against the last frame.
void hold_steady(const ModelTables& model, const Surface& surface, std::int32_t frames,
                 RegionSet& regions) noexcept;

}  // namespace pliant

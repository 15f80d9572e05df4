// What stands still is held still: noise alone moves nothing.
#pragma once

#include "core/track/model_tables.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

/// The part of the motion from `before` to `after` that noise does not explain: a share s² / (s² + noise²) of
/// it, s being how far it moves a body of radius 2 · `half_radius` about `centre` (model frame, metres) in
/// the root mean square. Lags by less than the noise behind steady motion.
[[nodiscard]] RigidTransform steadied(const RigidTransform& before, const RigidTransform& after,
                                      const Vector3& centre, double half_radius, double noise) noexcept;

/// How much of the sensor's σ is left in a pose from many readings.
inline constexpr double kNoiseOfPose = 0.5;

/// Steadies every region against the last frame.
void hold_steady(const ModelTables& model, const Surface& surface, RegionSet& regions) noexcept;

}  // namespace pliant

// Where the regions will be in this frame, and which part of the picture to look at.
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

/// How much of a frame's motion is expected again: hands accelerate, and what nothing observes must come to
/// rest.
inline constexpr double kMotionKept = 0.8;

/// Sets `predicted` and `pose` of every living region: the damped motion of the last frame on top of its last
/// pose. Regions that were not seen move with their parent.
void predict(RegionSet& regions) noexcept;

/// Takes a region's prediction back to its last pose where the surface says that it did not move on: the pose
/// under which more of the first `sample` model points agree with the readings stays.
void choose_still_or_moving(const ModelTables& model, const Surface& surface, const Projector& projector,
                            const PointState& points, std::size_t sample, RegionSet& regions) noexcept;

/// The part of the picture that holds all regions with room for what they may have moved besides.
/// `reach`: room around the projected points, 1/16 mm.
[[nodiscard]] Window predicted_window(const ModelTables& model, const Projector& projector,
                                      const PointState& points, const RegionSet& regions, std::int32_t reach,
                                      int width, int height) noexcept;

}  // namespace pliant

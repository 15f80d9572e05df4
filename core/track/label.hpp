// The inlier test: which points are where their region puts them, which are off it, and which are not seen.
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

/// What a frame shows of the points that face the camera inside the picture.
struct SightCounts {
  std::uint32_t facing = 0;  ///< face the camera inside the picture
  std::uint32_t agree = 0;
  std::uint32_t in_front = 0;  ///< the camera sees through them
  std::uint32_t behind = 0;    ///< something stands before them
  std::uint32_t bulged = 0;    ///< of those before: connected to the object's surface, so its own
};

/// Looks at every point under its region's pose, gathers evidence over the frames, lets points go over to a
/// neighbouring region that explains them better, and sets sight, residual, match and label.
/// A point that stands behind the readings is the object's own bulge only where the surface climbs there
/// steadily from its rigid neighbours in the model's graph; a step is something else in front, and the point
/// is not observed.
SightCounts label(const ModelTables& model, const Surface& surface, const Projector& projector,
                  const RegionSet& regions, const Tolerance& tolerance, PointState& points) noexcept;

/// Gives every point that was not seen lately the home of the nearest seen point along the model's surface
/// graph.
void carry_homes_to_unseen(const ModelTables& model, PointState& points) noexcept;

}  // namespace pliant

// A base region that stays behind while the object moves on has lost its hold on it.
#pragma once

#include "core/track/part_search.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

/// Where less than half of what is seen of the base region stands where it puts it, but one rigid motion
/// puts more than twice as much of it where the warp took it, the base goes there; the evidence that those
/// points were off it is void.
void regain_hold(const ModelTables& model, const PatchTables& patches, const PatchWarp& warp,
                 const Tolerance& tolerance, TrackedRegion& base, PointState& points) noexcept;

}  // namespace pliant

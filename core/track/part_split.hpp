// Makes a region of a part that moves in its own way.
#pragma once

#include "core/track/regroup.hpp"

namespace pliant {

/// Points of region `from`, all or those of one patch, become region `to`'s.
void give_points(const RegroupContext& context, std::int8_t from, std::int8_t to, int patch,
                 PointState& points) noexcept;

/// The inlier test's limit at the depth of what `pose` moves, metres.
[[nodiscard]] double limit_at(const RegroupContext& context, const RigidTransform& pose) noexcept;

/// Looks through the regions for one of which a part has moved in its own way for enough frames, and makes a
/// region of that in a free slot, or gives it to the region beside it whose motion it shares. True when it
/// did.
bool split_parts(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
                 RegionSet& regions, PointState& points) noexcept;

}  // namespace pliant

// Which region is the base.
#pragma once

#include "core/track/regroup.hpp"

namespace pliant {

/// The base is the largest body towards the camera, as it was at first, so that its pose rests on many
/// readings: where it holds less than a third of the points that face the camera, hidden ones or not, and
/// another region half as many again, in the `frames`th frame in a row, that one takes its place and id, and
/// what the base hung on hangs on it. Goes by TrackedRegion::facing. True when it did.
bool hand_over_base(const RegroupContext& context, int frames, RegroupState& state, RegionSet& regions,
                    PointState& points) noexcept;

}  // namespace pliant

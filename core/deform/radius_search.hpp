// Deformed points that the warp did not bring onto a reading (paper, section 3.3): the nearest free reading
// within a radius.
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

/// How far from a deformed point its reading may lie, in inlier limits.
constexpr std::int32_t kSearchLimits = 2;

/// Sets `match` and `residual` of the points labelled deformed that have no match: the
/// nearest reading within `radius` (1/16 mm) of their position that no other point matched. Points without
/// one stay. `taken`: one bit a pixel of the picture, scratch.
void search_deformed(const ModelTables& model, const Surface& surface, const Projector& projector,
                     std::int32_t radius, std::span<std::uint32_t> taken, PointState& points) noexcept;

}  // namespace pliant

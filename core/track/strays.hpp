// Points that were left behind.
#pragma once

#include "core/deform/patch_warp.hpp"
#include "core/track/patches.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

/// Regions are pieces of the surface: a point's is that of most points of its patch or of a patch beside it.
/// One whose region went elsewhere goes over to its patch's. `warp.home`: of this frame.
void recall_strays(const PatchTables& patches, const PatchWarp& warp, PointState& points) noexcept;

}  // namespace pliant

// What the readings tell of a part's motion.
#pragma once

#include "core/deform/patch_warp.hpp"
#include "core/track/patches.hpp"

namespace pliant {

/// Do the readings of a set of patches, which `pose` puts where they are, tell its motion but for two of the
/// six freedoms? A round limb may turn about itself and slide along itself unnoticed, and its joint knows
/// better; a smooth piece of surface slides any way, and what a pose says of its points along the surface
/// means nothing. Outlines count as readings.
[[nodiscard]] bool tells_its_motion(const PatchTables& patches, const PatchWarp& warp, const PatchSet& set,
                                    const RigidTransform& pose) noexcept;

}  // namespace pliant

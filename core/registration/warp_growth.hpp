// The warp settles outwards from what the regions explain: a patch takes readings once one beside it is where
// the scene shows it, so that no limb is drawn to what lies near its old place by chance.
#pragma once

#include "core/registration/warp_stiffness.hpp"

namespace pliant {

/// Brings the patches to where the scene shows them, from their first poses. Patches that stay with their
/// region: room.fixed.
void grow_settled(WarpSamples& samples, const WarpStiffness& stiffness) noexcept;

/// Lets what slid along the surface meanwhile slide back: all that is not fixed, with hardly any stiffness,
/// which alone holds it along the surface.
void relax_settled(WarpSamples& samples, const WarpStiffness& stiffness) noexcept;

}  // namespace pliant

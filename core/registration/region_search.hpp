// The chain's steps (section 3.2): one more rigid region among what is left, and where regions meet.
#pragma once

#include <span>

#include "core/registration/registration_state.hpp"

namespace pliant {

/// One more rigid region; false when there is none. Its points are marked in s.proposal: open points, and
/// points of the regions at `poses` (scene <- model, the base first) that it explains much better. `noise`:
/// the scene's, metres.
[[nodiscard]] bool find_region(RegistrationState& s, const InstanceBuffers& buffers,
                               std::span<const RigidTransform> poses, double noise,
                               RigidTransform& pose) noexcept;

/// Where regions meet, a point belongs to the one whose surface is nearer; then each region is aligned on its
/// own points.
void settle_borders(RegistrationState& s, InstanceBuffers& buffers, std::span<RigidTransform> poses,
                    double noise) noexcept;

}  // namespace pliant

// The chain of rigid transforms of one instance (section 3.2).
#pragma once

#include "core/registration/registration_state.hpp"

namespace pliant {

/// From the base's pose: the inlier test, and the same again on what is left, region by region. Fills labels,
/// positions, regions; marks the scene points that the regions explain as taken.
void build_chain(RegistrationState& s, const RigidTransform& pose, InstanceBuffers& buffers,
                 InstanceResult& instance) noexcept;

}  // namespace pliant

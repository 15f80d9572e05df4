// The rest of a registration: instances, the chain of rigid transforms, the deformed points (sections 3.2
// and 3.3).
#pragma once

#include "core/registration/registration_state.hpp"

namespace pliant {

/// Groups the matches that no instance explains yet, refines the best groups on the surface and returns the
/// best one's score (see InstanceResult) and pose (scene <- model); a score below 0 when there is none.
[[nodiscard]] double find_instance(RegistrationState& s, RigidTransform& pose) noexcept;

/// From the base's pose: the inlier test, and the same again on what is left, region by region. Fills labels,
/// positions, regions; marks the scene points that the regions explain as taken.
void build_chain(RegistrationState& s, const RigidTransform& pose, InstanceBuffers& buffers,
                 InstanceResult& instance) noexcept;

/// Radius search for the points that no region explains, among scene points that no region explains, one to
/// one.
void find_deformed(RegistrationState& s, InstanceBuffers& buffers, InstanceResult& instance) noexcept;

}  // namespace pliant

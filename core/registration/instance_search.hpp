// Grouping (section 3.2): the pose of the best instance among the matches.
#pragma once

#include "core/registration/registration_state.hpp"

namespace pliant {

/// Groups the matches that no instance explains yet, refines the best groups on the surface and returns the
/// best one's score (see InstanceResult) and pose (scene <- model); a score below 0 when there is none.
[[nodiscard]] double find_instance(RegistrationState& s, RigidTransform& pose) noexcept;

}  // namespace pliant

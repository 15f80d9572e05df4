// Grouping (section 3.2): the pose of the best instance among the matches.
#pragma once

#include "core/registration/registration_state.hpp"

namespace pliant {

/// A pose must have this share of the model's points on the scene's surface, with its normals. Absent objects
/// reach 0.38; what is seen from one side only is judged by free space instead.
inline constexpr double kConvincingShare = 0.42;
/// A pose between the two is believed where its chain of regions explains kExplainedShare of the model: half
/// of a wolf that bends everywhere is shown by any one pose. The chains of absent objects reach 0.16.
inline constexpr double kDoubtfulShare = 0.36, kExplainedShare = 0.6;

/// Groups the matches that no instance explains yet, refines the best groups on the surface and returns the
/// best one's score (see InstanceResult) and pose (scene <- model); a score below 0 when there is none, or
/// none that stands out: then the scene fits the model in other attitudes as well.
[[nodiscard]] double find_instance(RegistrationState& s, RigidTransform& pose) noexcept;

}  // namespace pliant

// The warp of a registered cloud: the model's patches, held together by springs, follow the scene where no
// rigid region explains it, so that every point of the model has a place that matter could take.
#pragma once

#include "core/registration/registration_state.hpp"

namespace pliant {

/// From the chain's regions and labels: `buffers.positions` of all points (scene frame). Regions hold their
/// own points; every other point goes where the springs and the scene take it. What the warp finds elsewhere
/// than its region would put it is labelled kNotObserved: the region explained it by chance.
void warp_cloud(RegistrationState& s, InstanceBuffers& buffers) noexcept;

}  // namespace pliant

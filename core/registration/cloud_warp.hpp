// The warp of a registered cloud: the model's patches, held together by the tracker's springs, follow the
// scene where no rigid region explains it, so that every point of the model has a place that matter could
// take.
#pragma once

#include "core/deform/elastic_system.hpp"
#include "core/registration/registration_state.hpp"

namespace pliant {

struct CloudWarpSettings {
  int rounds = 10;      ///< of looking up the scene and solving [1, 64]
  int iterations = 16;  ///< of the solver in each round [1, 64]
};

/// From the chain's regions and labels: `buffers.positions` of all points (scene frame). Regions hold their
/// own points; every other point goes where the springs and the free part of the scene take it.
void warp_cloud(RegistrationState& s, const CloudWarpSettings& settings, InstanceBuffers& buffers) noexcept;

}  // namespace pliant

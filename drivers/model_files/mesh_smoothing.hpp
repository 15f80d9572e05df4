// Takes the grain off a scanned surface.
#pragma once

#include "drivers/model_files/mesh.hpp"

namespace pliant {

/// Each round moves every vertex towards the mean of its neighbours and then a little farther back, which
/// lessens what is shorter than some edges and neither shrinks nor flattens what is longer (Taubin: A signal
/// processing approach to fair surface design, SIGGRAPH 1995). Vertices on a border stay where they are.
void smooth_grain(Mesh& mesh, int rounds);

}  // namespace pliant

// Where the patches of a warp start: with the region that they hang on, or as matches that bear each other
// out say.
#pragma once

#include <cstddef>

#include "core/registration/registration_state.hpp"

namespace pliant {

/// What the rounds of a warp work with.
struct Warp {
  RegistrationState& s;
  InstanceBuffers& buffers;
  WarpRoom& room;
};

/// From the labels: the region of each patch (room.home), how much of the patch it holds, and the patches'
/// first poses.
void find_homes(Warp& w) noexcept;

/// Matches of points that may move, each borne out by its neighbours: the pose that its local frames propose
/// brings most of the matches around it to their scene points too. A limb that bends is rigid over so short a
/// way. Their patches, and those beside, start there; room.borne: how many agree.
void find_starts(Warp& w) noexcept;

}  // namespace pliant

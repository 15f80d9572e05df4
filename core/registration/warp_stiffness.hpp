// How matter holds the patches of a warped cloud together, and a step of the warp.
#pragma once

#include "core/registration/warp_samples.hpp"

namespace pliant {

/// Of a border edge of the surface graph.
struct WarpStiffness {
  double stretch = 0;  ///< in weighted readings
  double bend = 0;     ///< in weighted readings times metres squared
  double strain = 0;   ///< that the material stands
};

/// An edge gives by the material's strain of its length, or bends by that angle, where a reading is off by a
/// quarter of the spacing: what sampling leaves.
[[nodiscard]] WarpStiffness stiffness_of(const RegistrationState& s) noexcept;

/// What a step may do.
struct WarpHold {
  double share = 1;  ///< of the stiffness
  double limit = 1;  ///< a spring gives way beyond it: in fifths of a patch's radius, in halves of a radian
  double following = 1;            ///< times the stiffness against bending where a patch takes no readings
  const PatchSet* limb = nullptr;  ///< its joint bends freely
};

/// Springs at the borders of what moves. A joint tears the ring about it, as an opening of the model's
/// surface would be: what is torn far pulls no more.
void add_springs(WarpRoom& room, const WarpStiffness& stiffness, const WarpHold& hold) noexcept;

/// Solves the system and moves the patches that are not held. How far the farthest went, metres; below 0 when
/// the system is singular.
double move_patches(WarpRoom& room) noexcept;

}  // namespace pliant

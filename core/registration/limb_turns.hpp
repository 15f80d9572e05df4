// Limbs that turned farther than their patches can follow from one to the next: what hangs on the settled
// part is turned about its joint as a whole, bent as the scene shows it, and kept where the scene bears it
// out.
#pragma once

#include <array>
#include <cstddef>

#include "core/registration/warp_stiffness.hpp"

namespace pliant {

/// The limbs that were tried in vain, so that none is tried twice.
struct LimbMemory {
  static constexpr std::size_t kMost = 64;  ///< limbs tried in one warp
  std::array<PatchSet, kMost> failed{};
  std::size_t count = 0, tried = 0;
};

/// Tries every connected piece of what is not settled, and each with what lies around it: a head that turned
/// looks settled but for its ears. Samples must be placed and targets owned; leaves them so. True when a limb
/// moved.
bool turn_limbs(WarpSamples& samples, const WarpStiffness& stiffness, LimbMemory& memory) noexcept;

}  // namespace pliant

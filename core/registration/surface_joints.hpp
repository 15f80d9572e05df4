// Mechanical constraints on the chain: matter bends easily and hardly stretches, so that a part stays joined
// to what it hangs on. Distances along the model's surface bound how far apart two of its points can come.
#pragma once

#include <cstdint>
#include <span>

#include "core/registration/registration_state.hpp"

namespace pliant {

/// How far along the surface every model point is from the nearest one that a region explains, by more than a
/// strip, and which that is: s.along (metres) and s.anchor. Bounded sweeps over the surface graph; takes
/// s.proposal.
void measure_reach(RegistrationState& s, std::span<const std::int8_t> labels) noexcept;

/// Whether model point `i` can have come to `scene`, by how far it hangs from what `poses` explain. After
/// measure_reach().
[[nodiscard]] bool within_reach(const RegistrationState& s, std::span<const std::int8_t> labels,
                                std::span<const RigidTransform> poses, std::size_t i,
                                const Vector3& scene) noexcept;

/// By how much `pose` would tear the piece `piece` of s.islands off what the other regions explain, metres,
/// at least 0: how far apart the two transforms take what lies between, where they agree best, less what
/// matter stretches. After measure_reach(). A piece that hangs on nothing tears nothing.
[[nodiscard]] double joint_gap(const RegistrationState& s, std::span<const std::int8_t> labels,
                               std::span<const RigidTransform> poses, std::uint32_t piece,
                               const RigidTransform& pose) noexcept;
/// The largest such gap that is no tear.
[[nodiscard]] double largest_joint_gap(const RegistrationState& s) noexcept;

}  // namespace pliant

// What the stages behind the matches share: tolerances, the clouds to align with, readings, and what is
// explained.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/registration/cloud_align.hpp"
#include "core/registration/registration_state.hpp"

namespace pliant {

inline constexpr std::size_t kFinePoints = 2500;  ///< model points of a last refinement

/// By how much a right match may be off, metres: one and a half times the distance of the model's keypoints.
[[nodiscard]] double match_tolerance(const RegistrationState& s) noexcept;
/// Within which a point of the working cloud stands for a point of the surface, metres.
[[nodiscard]] double working_reach(const RegistrationState& s) noexcept;
/// The coarse scene with normals, and all of it without.
[[nodiscard]] CloudTarget working_target(const RegistrationState& s) noexcept;
[[nodiscard]] CloudTarget base_target(const RegistrationState& s) noexcept;

/// Matches that are wanted(model index, scene point) and whose scene point no instance or region explains.
template <typename Wanted>
std::size_t collect_matches(RegistrationState& s, Wanted&& wanted) noexcept {
  const auto near = static_cast<float>(s.spacing);
  std::size_t count = 0;
  for (std::size_t k = 0; k < s.posed_count; ++k) {
    if (!wanted(s.matches[k].model, s.posed[k].scene)) continue;
    float square = 0;
    if (s.base_grid.nearest_if(s.posed[k].scene, near, square,
                               [&](std::uint32_t i) { return s.base_taken[i] != 0; }) != PointGrid::kNone)
      continue;
    s.posed_left[count++] = s.posed[k];
  }
  return count;
}

/// align_to_cloud() with all of the scene; counts the work.
std::size_t align_to_base(const RegistrationState& s, std::span<const std::uint16_t> which,
                          const AlignSettings& settings, RigidTransform& pose) noexcept;
/// The last touch: on all scene points, with a gate of a spacing and a half or four times the noise.
void refine(const RegistrationState& s, std::span<const std::uint16_t> which, double noise,
            RigidTransform& pose) noexcept;

/// Takes the readings of the scene (`only_free`: of what no instance explains) under a pose.
void measure(RegistrationState& s, const RigidTransform& pose, double noise, bool only_free) noexcept;

/// Median of the readings' spread: the scene's noise, metres. After measure().
[[nodiscard]] double scene_noise(RegistrationState& s) noexcept;

/// How far a point's surroundings are off the surface as a share of what is allowed: a spacing, or four times
/// what noise leaves of the mean of the readings. Negative where the scene shows nothing. After measure().
[[nodiscard]] float off_surface(const RegistrationState& s, std::size_t i, double noise) noexcept;

[[nodiscard]] inline bool on_surface(float off) noexcept {
  return off >= 0 && off <= 1;
}

/// Marks the scene points that lie on the points labelled `label`.
void take_points(RegistrationState& s, const InstanceBuffers& buffers, std::int8_t label,
                 const RigidTransform& pose, double noise) noexcept;

}  // namespace pliant

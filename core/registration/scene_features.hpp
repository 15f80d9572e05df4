// The first stages of a registration: normals, keypoints, descriptors, matches (the paper's sections 3.1
// and 3.2).
#pragma once

#include <cstdint>
#include <span>

#include "core/registration/registration_state.hpp"

namespace pliant {

/// Descriptors of the model keypoints: those stored, or all anew when more are asked for.
void describe_model(RegistrationState& s) noexcept;
/// Drops duplicates and non-finite points, thins out what is denser than the model, indexes the rest.
void thin_scene(RegistrationState& s, std::span<const Point3f> scene) noexcept;
/// All points lie on one plane or line.
[[nodiscard]] bool scene_is_flat(const RegistrationState& s) noexcept;
/// Normals of the working cloud, all away from the matter.
void find_normals(RegistrationState& s) noexcept;
/// About `wanted` keypoints by uniform sampling.
void sample_keypoints(RegistrationState& s, std::uint32_t wanted) noexcept;
void describe_keypoints(RegistrationState& s) noexcept;
/// The best model keypoint of every scene keypoint.
void match_keypoints(RegistrationState& s) noexcept;

}  // namespace pliant

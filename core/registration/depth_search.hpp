// Instances of the model in a depth picture, or in a cloud seen from one viewpoint, judged by free space.
#pragma once

#include <cstddef>
#include <span>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/registration/registration_state.hpp"

namespace pliant {

/// One instance that a picture shows.
struct SeenInstance {
  RigidTransform pose;  ///< camera <- model
  double score = 0;     ///< Detection::score
};

/// Bytes that search_picture() needs for pictures of up to `pixels` pixels.
[[nodiscard]] std::size_t depth_search_bytes(const ModelView& model, std::size_t pixels) noexcept;

/// Searches a picture; writes the instances, best first, and returns how many. None when the picture does not
/// fit the state's memory. `observer` is told of the stages up to grouping.
[[nodiscard]] std::size_t search_picture(RegistrationState& s, const DepthFrame& frame,
                                         const Intrinsics& camera, const SensorDescription& sensor,
                                         const RegistrationObserver& observer,
                                         std::span<SeenInstance> seen) noexcept;

/// Draws a cloud as RegistrationState::eye sees it: pose and intrinsics of a camera that has all of it in
/// view, one pixel for about every second point. Returns the share of the points that are in sight from there
/// (not behind nearer ones); 0 when the cloud surrounds the eye or cannot be drawn.
[[nodiscard]] double draw_cloud(RegistrationState& s, std::span<const Point3f> scene, DepthFrame& frame,
                                Intrinsics& camera, RigidTransform& scene_from_camera) noexcept;

}  // namespace pliant

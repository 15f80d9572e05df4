// The picture of a tracked frame: depth underneath, the model's points on it, axes and a key.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/camera/intrinsics.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "firmware-app/pictures/canvas.hpp"

namespace pliant {

/// What is to be seen. Everything is borrowed; metres, camera frame.
struct SceneView {
  Intrinsics camera;
  std::span<const std::uint16_t> depth;  ///< raw, rows from the top; empty: none is drawn
  std::span<const Point3f> positions;    ///< empty: the object is not tracked
  std::span<const std::int8_t> labels;   ///< one a point
  std::span<const float> displacement;   ///< lengths, one a point
  std::span<const RigidTransform> axes;  ///< the base first
  double spacing = 0;                    ///< of the model's points
  std::string title;
  std::vector<std::string> notes;  ///< lines at the lower edge
};

/// Points of regions in the regions' colours, deformed ones by displacement, those not observed left out.
[[nodiscard]] Canvas draw_scene(const SceneView& view);

/// A camera of `width` x `height` pixels at the sensor's place that shows all of `points` (not empty).
[[nodiscard]] Intrinsics camera_that_shows(std::span<const Point3f> points, int width, int height);

}  // namespace pliant

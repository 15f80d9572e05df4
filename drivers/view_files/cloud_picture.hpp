// Clouds as one camera would see them: from points to a depth picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera/intrinsics.hpp"
#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// A cloud of one view in the frame of its camera: x right, y down, z forward, metres.
using ViewCloud = std::vector<Vector3>;

/// A camera at the origin that sees all points in front of it of all clouds, as finely as the points lie,
/// in no more than 640×480 pixels, 8000 units a metre. Width 0: none of them has a point in front.
[[nodiscard]] Intrinsics camera_for(std::span<const ViewCloud> clouds);

/// The cloud's depth picture. A pixel's depth is that of the plane through the nearest layer of the points
/// within a pixel and a half of it; it has none where the points lie to one side of it only. Rows from the
/// top.
[[nodiscard]] std::vector<std::uint16_t> draw_cloud(const ViewCloud& cloud, const Intrinsics& camera);

}  // namespace pliant

// What stands still before the simulated camera, and where the camera is.
#pragma once

#include "core/geometry/rigid_transform.hpp"
#include "drivers/simulated/disparity_image.hpp"

namespace pliant::simulated {

/// A camera that looks down on a table.
struct View {
  double pitch = 0;     ///< degrees below the horizon
  double distance = 0;  ///< metres to the point looked at
  double height = 0;    ///< metres of that point above the table
};

/// camera <- table. Table frame: x right, y away from the camera, z up.
[[nodiscard]] RigidTransform camera_from_table(const View& view);

/// Draws the table, the panel behind it and four things that stand on it.
void draw_surroundings(const RigidTransform& camera_from_table, DisparityImage& image);

}  // namespace pliant::simulated

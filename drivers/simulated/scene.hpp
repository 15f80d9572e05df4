// What stands still before the simulated camera, and where the camera is.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/rigid_transform.hpp"
#include "drivers/simulated/disparity_image.hpp"

namespace pliant::simulated {

/// A camera that looks down on a table.
struct View {
  double pitch = 0;     ///< degrees below the horizon
  double distance = 0;  ///< metres to the point looked at
  double height = 0;    ///< metres of that point above the table
  double azimuth = 0;   ///< turns about the upright axis, to the right
};

/// camera <- table. Table frame: x right, y away from the camera, z up.
[[nodiscard]] RigidTransform camera_from_table(const View& view);

/// The table, the panel behind it and four things that stand on it.
class Surroundings {
 public:
  Surroundings();
  /// No heap call.
  void draw(const RigidTransform& camera_from_table, DisparityImage& image);

 private:
  struct Thing {
    std::vector<Vector3> vertices;  ///< table frame
    std::vector<std::array<std::uint32_t, 3>> triangles;
  };
  std::vector<Thing> things_;
  std::vector<Vector3> placed_;
};

}  // namespace pliant::simulated

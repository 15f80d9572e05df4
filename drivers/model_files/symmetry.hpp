// Poses in which an object looks (nearly) the same.
#pragma once

#include <string>
#include <vector>

#include "drivers/model_files/mesh.hpp"

namespace pliant {

struct Symmetry {
  Vector3 axis = Vector3::Zero();  ///< unit, model frame, through the middle of the surface
  int parts_of_turn = 2;           ///< 2: the same after half a turn, 4: after a quarter, …
};

/// Rotations about the main axes of the surface after which nine tenths of it lie within `tolerance` (metres)
/// of where it was. Not looked for about axes that the shape does not fix (a cube's, a sphere's).
/// `cloud`: points in farthest-point order.
[[nodiscard]] std::vector<Symmetry> find_symmetries(const OrientedCloud& cloud, double tolerance);

/// One line that names them; empty when there are none.
[[nodiscard]] std::string describe_symmetries(const std::vector<Symmetry>& symmetries);

}  // namespace pliant

// Makes a sound mesh of what a file holds.
#pragma once

#include <string>
#include <vector>

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/model_files/mesh.hpp"

namespace pliant {

/// Scales to metres, makes one vertex of those that (nearly) coincide (within a hundred-thousandth of the
/// extent and 0.05 mm: below the 0.1 mm that points may lie off the surface, above the rounding of the
/// formats), drops triangles without area, doubled triangles and, in a mesh, vertices of no triangle. What
/// was dropped is said in `warnings` where it may matter.
[[nodiscard]] Mesh clean_mesh(const Geometry& geometry, double metres_per_unit,
                              std::vector<std::string>& warnings);

}  // namespace pliant

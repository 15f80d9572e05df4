// Even sampling of a mesh.
#pragma once

#include <cstddef>

#include "drivers/model_files/mesh.hpp"

namespace pliant {

/// Square metres, both sides of a sheet counted once.
[[nodiscard]] double surface_area(const Mesh& mesh);

/// Distance of neighbours when `count` points are spread over `area` as evenly as can be (a hexagonal
/// lattice), and the reverse.
[[nodiscard]] double even_spacing(double area, double count);
[[nodiscard]] double even_count(double area, double spacing);

/// Whether the vertices alone describe the surface at this spacing: nineteen twentieths of its area lie in
/// triangles no point of which is farther than `spacing` from a corner.
[[nodiscard]] bool vertices_are_dense(const Mesh& mesh, double spacing);

/// `count` candidates for points, spread over the surface by area (deterministic: equal steps along the
/// summed area, Roberts' R2 sequence inside the triangles), with normals that are smooth over curved faces.
[[nodiscard]] OrientedCloud sample_surface(const Mesh& mesh, std::size_t count);

}  // namespace pliant

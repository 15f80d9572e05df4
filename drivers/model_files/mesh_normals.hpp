// Normals of a mesh whose triangles are wound outward.
#pragma once

#include <array>
#include <vector>

#include "drivers/model_files/mesh.hpp"

namespace pliant {

/// Unit normal of each vertex: those of its triangles weighed with their angle there, so that it does not
/// depend on how a face is cut into triangles (Thürmer, Wüthrich: Computing vertex normals from polygonal
/// facets, 1998). Zero where they cancel out.
[[nodiscard]] std::vector<Vector3> vertex_normals(const Mesh& mesh);

/// Unit normals of each triangle's corners: as above, but over those triangles at the vertex only that lean
/// less than 40° from this one. Smooth over curved faces, sharp at edges.
[[nodiscard]] std::vector<std::array<Vector3, 3>> corner_normals(const Mesh& mesh);

}  // namespace pliant

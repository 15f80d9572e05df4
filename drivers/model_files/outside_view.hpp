// Looks at a shape from all around, to tell which side of a surface is its outside.
#pragma once

#include <span>
#include <vector>

#include "drivers/model_files/mesh.hpp"

namespace pliant {

/// The corners and the middles of the edges of an icosahedron: 42 unit directions, evenly spread.
[[nodiscard]] std::vector<Vector3> view_directions();

/// How often a side of something was seen, counted in pixels over all views.
struct SideVotes {
  double front = 0;  ///< the side that the winding or normal points to
  double back = 0;
};

/// Draws the mesh from 42 directions into a depth picture, nearest first; every pixel is a vote for the side
/// of the triangle seen there, weighed with the cosine between the normal and the view. One entry a triangle.
[[nodiscard]] std::vector<SideVotes> see_triangles(const Mesh& mesh);

/// The same for points, drawn as discs that close the gaps between points `spacing` (metres) apart.
[[nodiscard]] std::vector<SideVotes> see_points(const OrientedCloud& cloud, double spacing);

/// Of what can be seen from all around of a shape, the share that is its outside: 1 for a closed one, about a
/// half for one whose back is missing. `spacing` as above.
[[nodiscard]] double outside_share(const OrientedCloud& cloud, double spacing);

}  // namespace pliant

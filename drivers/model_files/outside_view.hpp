// Looks at a shape from all around, to tell which side of a surface is its outside.
#pragma once

#include <span>
#include <vector>

#include "drivers/model_files/mesh.hpp"

namespace pliant {

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

}  // namespace pliant

// The neighbours of each model point along the surface.
#pragma once

#include <cstdint>
#include <vector>

#include "core/limits.hpp"
#include "drivers/model_files/mesh.hpp"

namespace pliant {

/// limits::kNeighbours indices a point, nearest first, kNoNeighbour where there are fewer. The nearest in
/// space that lie on the same sheet of the surface: normals turned by less than ~105°, so that the two sides
/// of a thin part are not joined while an edge is; not stacked above each other; not over a gap. Of these the
/// nearest in each eighth of a turn come first into consideration, so that the graph holds together where
/// points lie in lines.
[[nodiscard]] std::vector<std::uint16_t> neighbour_graph(const OrientedCloud& cloud, double spacing);

}  // namespace pliant

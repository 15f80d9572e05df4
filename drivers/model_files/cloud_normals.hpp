// Normals of a cloud without triangles.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "drivers/model_files/mesh.hpp"

namespace pliant {

/// Unit normals: the direction in which the sixteen nearest points spread least (Hoppe et al.: Surface
/// reconstruction from unorganized points, SIGGRAPH 1992), made consistent along a spanning tree of small
/// turns, each connected part then outward by the side that is seen from around. `spacing`: metres.
[[nodiscard]] std::vector<Vector3> estimate_normals(std::span<const Vector3> points, double spacing);

/// Takes the normals of the file where it has them, estimates the others in agreement with their neighbours,
/// and turns all of them when most that is seen from around faces away.
[[nodiscard]] std::vector<Vector3> complete_normals(std::span<const Vector3> points,
                                                    std::span<const Vector3> given, double spacing,
                                                    std::vector<std::string>& warnings);

}  // namespace pliant

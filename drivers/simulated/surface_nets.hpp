// Turns a solid into an even triangle mesh.
#pragma once

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/simulated/implicit.hpp"

namespace pliant::simulated {

/// The closed surface of `solid` inside the box [low, high], which it must not touch, as triangles whose
/// sides are about `spacing` (metres) long, counter-clockwise seen from outside, with unit normals.
/// Dual contouring of a grid without hermite data (Gibson: Constrained elastic surface nets, 1998), then a
/// few rounds of evening out and projection onto the surface.
[[nodiscard]] Geometry mesh_of(Solid solid, const Vector3& low, const Vector3& high, double spacing);

}  // namespace pliant::simulated

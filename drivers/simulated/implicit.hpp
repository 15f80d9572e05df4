// Solid shapes as functions that are negative inside. Exact distances where the comment says so.
#pragma once

#include "core/geometry/rigid_transform.hpp"

namespace pliant::simulated {

/// Distance.
[[nodiscard]] double sphere(const Vector3& p, const Vector3& centre, double radius);
/// Distance; a thick line from a to b.
[[nodiscard]] double capsule(const Vector3& p, const Vector3& a, const Vector3& b, double radius);
/// Distance; edges rounded by `radius`, which is part of the half size.
[[nodiscard]] double rounded_box(const Vector3& p, const Vector3& centre, const Vector3& half, double radius);
/// First-order distance.
[[nodiscard]] double ellipsoid(const Vector3& p, const Vector3& centre, const Vector3& radii);
/// First-order distance; (x/a)^4 + (y/b)^4 + (z/c)^2 = 1, the shape of a pillow.
[[nodiscard]] double pillow(const Vector3& p, const Vector3& half);
/// Distance; the side of the plane through `point` to which `normal` (unit) points is outside.
[[nodiscard]] double half_space(const Vector3& p, const Vector3& point, const Vector3& normal);

/// Union and difference whose seam is rounded over about `blend` metres.
[[nodiscard]] double smooth_union(double a, double b, double blend);
[[nodiscard]] double smooth_difference(double a, double b, double blend);

/// A solid.
using Solid = double (*)(const Vector3& p);

}  // namespace pliant::simulated

// The exact integer sums of a point-to-plane problem as equations in radians and metres.
#pragma once

#include "core/camera/surface.hpp"
#include "core/fixed/moments.hpp"
#include "core/geometry/vector6.hpp"

namespace pliant {

/// Adds the row of a point with a unit normal (Q14) to moments about `centre`: |point - centre| < 4 m.
inline void add_plane_row(PlaneMoments& moments, const IntPoint& point, const IntPoint& n,
                          std::int32_t residual, std::int32_t weight, const IntPoint& centre) noexcept {
  const std::int32_t x = point.x - centre.x, y = point.y - centre.y, z = point.z - centre.z;
  moments.add(
      {(y * n.z - z * n.y) >> 14, (z * n.x - x * n.z) >> 14, (x * n.y - y * n.x) >> 14, n.x, n.y, n.z},
      residual, weight);
}

/// Metres of a residual of 1.
inline constexpr double kResidualMetres = 1 / 256000.0;

/// a · x = b for the small motion x about the centre that the moments' arms were taken from.
struct PlaneEquations {
  Matrix6 a;
  Vector6 b;
};
[[nodiscard]] PlaneEquations plane_equations(const PlaneMoments& moments) noexcept;

}  // namespace pliant

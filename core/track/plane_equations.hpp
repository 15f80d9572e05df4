// The exact integer sums of a point-to-plane problem as equations in radians and metres.
#pragma once

#include "core/camera/surface.hpp"
#include "core/fixed/moment_rows.hpp"
#include "core/geometry/vector6.hpp"

namespace pliant {

/// The row of a point with a unit normal (Q14) about `centre`: |point - centre| < 4 m.
[[nodiscard]] inline MomentRow moment_row(const IntPoint& point, const IntPoint& n, std::int32_t residual,
                                          std::int32_t weight, const IntPoint& centre) noexcept {
  const std::int32_t x = point.x - centre.x, y = point.y - centre.y, z = point.z - centre.z;
  return {{(y * n.z - z * n.y) >> 14, (z * n.x - x * n.z) >> 14, (x * n.y - y * n.x) >> 14, n.x, n.y, n.z},
          residual,
          weight};
}

/// Adds it to moments about `centre`.
inline void add_plane_row(PlaneMoments& moments, const IntPoint& point, const IntPoint& n,
                          std::int32_t residual, std::int32_t weight, const IntPoint& centre) noexcept {
  const MomentRow row = moment_row(point, n, residual, weight, centre);
  moments.add(row.j, row.residual, row.weight);
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

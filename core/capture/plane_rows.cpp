#include "core/capture/plane_rows.hpp"

#include <algorithm>

#include "core/track/plane_equations.hpp"
#include "core/track/residual_spread.hpp"

namespace pliant {

namespace {

/// The integer kernel.
[[gnu::noinline]] PlaneMoments weighted(std::span<const PlaneRow> rows, const IntPoint& centre,
                                        std::int32_t limit) noexcept {
  PlaneMoments moments;
  for (const PlaneRow& row : rows)
    if (const std::int32_t w = tukey_weight(row.residual, limit); w != 0)
      add_plane_row(moments, row.point, {row.nx, row.ny, row.nz}, row.residual, w, centre);
  return moments;
}

RobustMoments about(std::span<const PlaneRow> rows, const ResidualSpread& spread, std::int32_t noise,
                    const IntPoint& centre) noexcept {
  RobustMoments robust;
  robust.centre = centre;
  robust.scale = std::max((spread.median() * 95) >> 6, std::max(noise / 2, 1));
  // Tukey's constant is 4.685
  robust.limit = std::max((robust.scale * 300) >> 6, noise * 8 / 5) * 16;
  robust.moments = weighted(rows, centre, robust.limit);
  return robust;
}

ResidualSpread spread_of(std::span<const PlaneRow> rows) noexcept {
  ResidualSpread spread;
  for (const PlaneRow& row : rows) spread.add(row.point, row.residual);
  return spread;
}

}  // namespace

RobustMoments robust_moments(std::span<const PlaneRow> rows, std::int32_t noise) noexcept {
  if (rows.empty()) return {};
  const ResidualSpread spread = spread_of(rows);
  return about(rows, spread, noise, spread.centre());
}

RobustMoments robust_moments(std::span<const PlaneRow> rows, std::int32_t noise,
                             const IntPoint& centre) noexcept {
  if (rows.empty()) return {};
  return about(rows, spread_of(rows), noise, centre);
}

}  // namespace pliant

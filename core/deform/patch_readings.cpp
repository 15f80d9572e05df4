#include "core/deform/patch_readings.hpp"

#include <algorithm>

#include "core/track/aside.hpp"
#include "core/track/associate.hpp"
#include "core/track/contour.hpp"
#include "core/track/placed_points.hpp"
#include "core/track/plane_equations.hpp"

namespace pliant {

namespace {

void add_aside(const PatchLook& look, int step, int u, int v, const IntPoint& at, const IntPoint& n,
               const IntPoint& centre, PlaneMoments& moments) noexcept {
  Aside aside;
  const AsideReach reach{look.gates.inward, look.gates.outward, step, look.gates.spacing};
  if (find_aside(look.surface, reach, u, v, at, n, aside))
    add_plane_row(moments, at, aside.direction, aside.distance * 16,
                  tukey_weight(aside.distance, look.gates.inward), centre);
}

void add_contour(const PatchLook& look, const IntPoint& at, const IntPoint& n, const IntPoint& centre,
                 PlaneMoments& moments) noexcept {
  std::int32_t distance = 0;
  const std::int32_t reach = look.gates.inward;
  if (find_contour(look.surface, look.projector, {reach, reach}, at, n, distance))
    add_plane_row(moments, at, n, distance * 16, tukey_weight(distance, reach), centre);
}

/// Pixels between looks aside for how well a patch fits: what lies farther aside pulls, but is no misfit.
constexpr int kNearStep = 1;

/// Where the sums go: of what the points meet, of what lies aside of them, and, if asked for, of what does so
/// no farther than kNearStep reaches.
struct Gathered {
  PlaneMoments& met;
  PlaneMoments& aside;
  PlaneMoments* near = nullptr;
};

/// The integer kernel: every point of a patch that faces the camera, beside the reading of its
/// pixel, or that lies on the outline, beside that, into the moments of its patch about the patch's centre.
/// Formats are those of PlaneMoments. Overflow bounds: gates <= kFarthestReading, so that a difference
/// squared stays below 2^26 and three below 2^28; arms are at most a model's extent, 2^16, times Q14 normals:
/// below 2^31 for the difference of two.
[[gnu::noinline]] void gather(const PatchLook& look, const PointState& points, std::size_t p,
                              const PatchWarp& warp, const Gathered& gathered) noexcept {
  const IntPoint centre = warp.centre[p];
  const PatchPoints& patch = look.model.by_patch;
  PlacedPoints placed;
  MomentRowBuffer rows(points.add_rows, gathered.met);
  const std::size_t begin = patch.begin[p], end = begin + patch.count[p];
  for (std::size_t first = begin; first < end; first += PlacedPoints::kMost) {
    const std::size_t count = std::min(PlacedPoints::kMost, end - first);
    placed.place({patch, first}, PatchPoints::filled_up(count), warp.fixed[p]);
    for (std::size_t k = 0; k < count; ++k) {
      if (placed.side[k] == Side::away) continue;
      const IntPoint at = placed.point(k), n = placed.normal(k);
      if (placed.side[k] == Side::rim) {
        add_contour(look, at, n, centre, gathered.met);
        continue;
      }
      int u = 0, v = 0;
      if (!look.projector.project(at, u, v)) continue;
      const std::uint16_t z8 = look.surface.depth_at(u, v);
      const std::int32_t gap = 2 * z8 - at.z;
      if (z8 != 0 && -gap > look.gates.outward) continue;
      if (z8 == 0 || gap > look.gates.inward) {
        add_aside(look, look.step, u, v, at, n, centre, gathered.aside);
        if (gathered.near != nullptr) add_aside(look, kNearStep, u, v, at, n, centre, *gathered.near);
        continue;
      }
      const IntPoint q = look.surface.vertex(u, v, z8);
      const std::int32_t residual = plane_distance(q, at, n) - points.misfit[patch.index[first + k]];
      const std::int32_t limit = (residual > 0 ? look.gates.outward : look.gates.inward) * 16;
      const std::int32_t w = tukey_weight(residual, limit);
      if (w == 0 || !look.surface.faces(u, v, Surface::normal_step(z8, look.gates.spacing), n)) continue;
      rows.add(moment_row(at, n, residual, w, centre));
    }
  }
  rows.flush();
}

/// Does the sum of squares fall by more than `much` when the patch follows its readings as far as a held one
/// may?
bool pulls(const PatchTables& patches, const PlaneMoments& moments, std::size_t p, double much) noexcept {
  Symmetric6 a;
  Vector6 b = Vector6::Zero();
  add_readings(moments, a, b);
  const double hold = kHoldShare * patches.sizes[p], turn = hold * 0.5 * patches.radius * patches.radius;
  // Readings resist, too: it falls by no more than without them.
  if (b.tail<3>().squaredNorm() / hold + b.head<3>().squaredNorm() / turn <= much) return false;
  a.add_shift_spring(hold);
  a.add_turn_spring(turn);
  Factor6 factor;
  return factor.factorise(a) && b.dot(factor.solve(b)) > much;
}

}  // namespace

void place_patches(const ModelTables& model, const PatchTables& patches, const ChosenPatches& chosen,
                   PatchWarp& warp) noexcept {
  for (std::size_t p = 0; p < patches.count; ++p) {
    if (!chosen[p]) continue;
    warp.fixed[p] = FixedPose(warp.pose[p], model.centre);
    const Vector3 c = warp.pose[p] * patches.centres[p] * kUnitsPerMetre;
    warp.centre[p] = {static_cast<std::int32_t>(c.x()), static_cast<std::int32_t>(c.y()),
                      static_cast<std::int32_t>(c.z())};
  }
}

void add_readings(const PlaneMoments& m, Symmetric6& a, Vector6& b) noexcept {
  const PlaneEquations equations = plane_equations(m);
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column <= row; ++column)
      a.at(row, column) += equations.a(static_cast<int>(row), static_cast<int>(column));
  b += equations.b;
}

void gather_readings(const PatchLook& look, const PointState& points, const ChosenPatches& chosen,
                     PatchWarp& warp) noexcept {
  place_patches(look.model, look.patches, chosen, warp);
  for (std::size_t p = 0; p < look.patches.count; ++p) {
    if (!chosen[p]) continue;
    warp.moments[p] = PlaneMoments();
    gather(look, points, p, warp, {warp.moments[p], warp.moments[p]});
  }
}

void measure_fits(const PatchLook& look, const PointState& points, const ChosenPatches& chosen, double much,
                  PatchWarp& warp, PatchMoments& moments, std::array<PatchFit, kMaxPatches>& fits) noexcept {
  place_patches(look.model, look.patches, chosen, warp);
  for (std::size_t p = 0; p < look.patches.count; ++p) {
    if (!chosen[p]) continue;
    moments[p] = PlaneMoments();
    PlaneMoments aside, near;
    gather(look, points, p, warp, {moments[p], aside, &near});
    near.add(moments[p]);
    const auto weight = static_cast<double>(near.weight);
    fits[p] = {weight / 256,
               weight > 0 ? static_cast<double>(near.square) / weight * kResidualMetres * kResidualMetres : 0,
               pulls(look.patches, near, p, much)};
    moments[p].add(aside);
  }
}

}  // namespace pliant

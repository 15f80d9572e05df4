#include "core/track/align.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/geometry/vector6.hpp"
#include "core/track/plane_equations.hpp"
#include "core/track/residual_spread.hpp"

namespace pliant {

namespace {

constexpr std::int32_t kFullWeight = 256;  // Q8

/// The weighted rows of region `k` about `centre`: the integer kernel of the step, on its own so that it can
/// be looked at.
[[gnu::noinline]] PlaneMoments region_moments(const PointState& points, std::int8_t k, const IntPoint& centre,
                                              std::int32_t limit, bool robust) noexcept {
  PlaneMoments moments;
  MomentRowBuffer rows(points.add_rows, moments);
  for (const Correspondence& c : points.correspondences.first(points.correspondence_count)) {
    if (c.region != k) continue;
    const std::int32_t w = robust ? tukey_weight(c.residual, limit) : kFullWeight;
    if (w == 0) continue;
    rows.add(moment_row(c.point, {c.nx, c.ny, c.nz}, c.residual, w, centre));
  }
  rows.flush();
  return moments;
}

/// Springs of `noise` (a reading's variance) over the squares of what the joint gives and turns.
void add_joint(const Joint& joint, const RigidTransform& pose, const Vector3& centre, double noise,
               Matrix6& a, Vector6& b) noexcept {
  const Vector3 at = pose * joint.place, arm = at - centre, gap = joint.target - at;
  const double k = noise / (joint.give * joint.give);
  Symmetric6 spring;
  spring.add_point_spring(k, arm);
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = 0; column < 6; ++column)
      a(static_cast<int>(row), static_cast<int>(column)) +=
          spring.a[row >= column ? Symmetric6::index(row, column) : Symmetric6::index(column, row)];
  b.head<3>() += k * arm.cross(gap);
  b.tail<3>() += k * gap;
  if (joint.turn == 0) return;
  const double twist = noise / (joint.turn * joint.turn);
  for (int i = 0; i < 3; ++i) a(i, i) += twist;
  b.head<3>() += twist * turn_between(joint.rotation, pose.rotation);
}

}  // namespace

AlignSteps align(const Surface& surface, const AlignSettings& settings, const Joints& joints,
                 const PointState& points, RegionSet& regions) noexcept {
  AlignSteps steps = for_every_region(-1.0);
  std::array<ResidualSpread, limits::kMaxRegions> spreads{};
  for (const Correspondence& c : points.correspondences.first(points.correspondence_count))
    spreads[static_cast<std::size_t>(c.region)].add(c.point, c.residual);

  for (std::size_t k = 0; k < regions.size(); ++k) {
    TrackedRegion& region = regions[k];
    const ResidualSpread& spread = spreads[k];
    if (!region.alive || spread.count < kFewestCorrespondences) continue;
    const IntPoint centre = spread.centre();
    // 1.4826 · median is σ of a normal distribution; Tukey's constant is 4.685
    const std::int32_t noise = surface.sigma(centre.z);
    region.scale = std::max((spread.median() * 95) >> 6, noise / 2);
    // never narrower than Tukey's width at what smoothing leaves of σ, a third
    const std::int32_t narrowest = noise * 8 / 5;
    const std::int32_t limit =
        std::clamp((region.scale * 300) >> 6, narrowest, std::max(settings.widest[k], narrowest)) * 16;

    const PlaneMoments moments =
        region_moments(points, static_cast<std::int8_t>(k), centre, limit, settings.robust);
    if (moments.rows < kFewestCorrespondences) continue;

    PlaneEquations equations = plane_equations(moments);
    Matrix6& a = equations.a;
    Vector6& b = equations.b;
    const double spread_metres = region.scale / kUnitsPerMetre;
    const Vector3 centre_metres =
        Vector3(centre.x / kUnitsPerMetre, centre.y / kUnitsPerMetre, centre.z / kUnitsPerMetre);
    const Vector6 back = motion_between(region.predicted, region.pose, centre_metres);
    for (int i = 0; i < 6; ++i) {
      const double sigma = i < 3 ? settings.prior_rotation : settings.prior_translation;
      const double information = spread_metres * spread_metres / (sigma * sigma);
      a(i, i) += information;
      b[i] += information * back[i];
    }
    if (joints[k].tied) add_joint(joints[k], region.pose, centre_metres, spread_metres * spread_metres, a, b);
    const Vector6 x = a.ldlt().solve(b);
    if (!(x.squaredNorm() < 1.0)) continue;  // also for not-a-number
    region.pose = motion_about(x, centre_metres) * region.pose;
    region.pose.rotation = orthonormalised(region.pose.rotation);
    region.rms = std::sqrt(static_cast<double>(moments.square) / static_cast<double>(moments.weight)) *
                 kResidualMetres;
    steps[k] = std::sqrt(x.tail<3>().squaredNorm() +
                         settings.half_radius * settings.half_radius * x.head<3>().squaredNorm());
  }
  return steps;
}

}  // namespace pliant

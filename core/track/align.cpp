#include "core/track/align.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/geometry/vector6.hpp"

namespace pliant {

namespace {

constexpr int kBins = 512;  // of |residual|, 1/16 mm each

/// Counts, centres and the histogram of |residual| of one region.
struct Spread {
  std::uint32_t count = 0;
  std::int64_t x = 0, y = 0, z = 0;
  std::array<std::uint32_t, kBins> bins{};

  void add(const Correspondence& c) noexcept {
    ++count;
    x += c.point.x;
    y += c.point.y;
    z += c.point.z;
    ++bins[static_cast<std::size_t>(std::min(std::abs(c.residual) >> 4, kBins - 1))];
  }
  [[nodiscard]] std::int32_t median() const noexcept {
    std::uint32_t below = 0;
    for (int i = 0; i < kBins; ++i) {
      below += bins[static_cast<std::size_t>(i)];
      if (2 * below >= count) return i + 1;
    }
    return kBins;
  }
};

/// The weighted rows of region `k` about `centre`: the integer kernel of the step, on its own so that it can
/// be looked at.
[[gnu::noinline]] PlaneMoments region_moments(std::span<const Correspondence> all, std::int8_t k,
                                              const IntPoint& centre, std::int32_t limit) noexcept {
  PlaneMoments moments;
  for (const Correspondence& c : all) {
    if (c.region != k) continue;
    const std::int32_t w = tukey_weight(c.residual, limit);
    if (w == 0) continue;
    const std::int32_t px = c.point.x - centre.x, py = c.point.y - centre.y, pz = c.point.z - centre.z;
    moments.add({(py * c.nz - pz * c.ny) >> 14, (pz * c.nx - px * c.nz) >> 14, (px * c.ny - py * c.nx) >> 14,
                 c.nx, c.ny, c.nz},
                c.residual, w);
  }
  return moments;
}

Matrix6 symmetric(const PlaneMoments& m, const Vector6& scale) noexcept {
  Matrix6 a;
  std::size_t k = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) {
      a(row, column) = static_cast<double>(m.a[k++]) * scale[row] * scale[column];
      a(column, row) = a(row, column);
    }
  return a;
}

/// What turns `pose` into `target`, about `centre`: rotation vector and translation.
Vector6 difference(const RigidTransform& target, const RigidTransform& pose, const Vector3& centre) noexcept {
  const RigidTransform step = target * pose.inverse();
  Vector6 x;
  x.head<3>() = small_vector_from_rotation(step.rotation);
  x.tail<3>() = step * centre - centre;
  return x;
}

/// A spring of `noise` squared over the joint's give squared.
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
}

}  // namespace

void align(const Surface& surface, const AlignSettings& settings, const Joints& joints,
           const PointState& points, RegionSet& regions) noexcept {
  const auto all = points.correspondences.first(points.correspondence_count);
  std::array<Spread, limits::kMaxRegions> spreads{};
  for (const Correspondence& c : all) spreads[static_cast<std::size_t>(c.region)].add(c);

  for (std::size_t k = 0; k < regions.size(); ++k) {
    TrackedRegion& region = regions[k];
    const Spread& spread = spreads[k];
    if (!region.alive || spread.count < kFewestCorrespondences) continue;
    const IntPoint centre{static_cast<std::int32_t>(spread.x / spread.count),
                          static_cast<std::int32_t>(spread.y / spread.count),
                          static_cast<std::int32_t>(spread.z / spread.count)};
    // 1.4826 · median is σ of a normal distribution; Tukey's constant is 4.685
    const std::int32_t noise = surface.sigma(centre.z);
    region.scale = std::max((spread.median() * 95) >> 6, noise / 2);
    // never narrower than Tukey's width at what smoothing leaves of σ, a third
    const std::int32_t narrowest = noise * 8 / 5;
    const std::int32_t limit =
        std::clamp((region.scale * 300) >> 6, narrowest, std::max(settings.widest, narrowest)) * 16;

    const PlaneMoments moments = region_moments(all, static_cast<std::int8_t>(k), centre, limit);
    if (moments.rows < kFewestCorrespondences) continue;

    Vector6 unit;
    unit << 1 / kUnitsPerMetre, 1 / kUnitsPerMetre, 1 / kUnitsPerMetre, 1 / 16384.0, 1 / 16384.0, 1 / 16384.0;
    constexpr double kWeight = 1 / 256.0, kResidual = 1 / 256000.0;
    Matrix6 a = symmetric(moments, unit) * kWeight;
    Vector6 b;
    for (int i = 0; i < 6; ++i)
      b[i] = static_cast<double>(moments.b[static_cast<std::size_t>(i)]) * unit[i] * kWeight * kResidual;
    const double spread_metres = region.scale / kUnitsPerMetre;
    const Vector3 centre_metres =
        Vector3(centre.x / kUnitsPerMetre, centre.y / kUnitsPerMetre, centre.z / kUnitsPerMetre);
    const Vector6 back = difference(region.predicted, region.pose, centre_metres);
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
    region.rms =
        std::sqrt(static_cast<double>(moments.square) / static_cast<double>(moments.weight)) * kResidual;
  }
}

}  // namespace pliant

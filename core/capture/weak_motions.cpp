#include "core/capture/weak_motions.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/symmetric_eigen6.hpp"

namespace pliant {

namespace {

constexpr double kWeak = 0.3;      // share of a motion: a box has about 0.4
constexpr double kTelling = 0.42;  // sine of 25°: four times what the fixed errors of a sensor lean
constexpr double kSlip = 0.1;      // of the radius
constexpr double kFeigned = 0.015;  // what normals feign that lean by 5° at random: √15 · 0.087³ / kTelling²
constexpr double kAsked = 0.3;  // more is never asked for

/// What the telling rows say of one motion.
struct Told {
  double information = 0, moved = 0;
  double confirmed = 0;  // of the information, what the view's own normals tell too
};

Told told_of(const Vector6& motion, std::span<const PlaneRow> rows, const RobustMoments& robust,
             bool stands) noexcept {
  const Vector3 turn = motion.head<3>(), shift = motion.tail<3>();
  Told told;
  for (const PlaneRow& row : rows) {
    const std::int32_t weight = tukey_weight(row.residual, robust.limit);
    if (weight == 0) continue;
    const Vector3 arm =
        Vector3(row.point.x - robust.centre.x, row.point.y - robust.centre.y, row.point.z - robust.centre.z) /
        kUnitsPerMetre;
    const Vector3 way = turn.cross(arm) + shift;
    const double along = (way.x() * row.nx + way.y() * row.ny + way.z() * row.nz) / 16384.0;
    const double own = (way.x() * row.vx + way.y() * row.vy + way.z() * row.vz) / 16384.0;
    const double limit = kTelling * kTelling * way.squaredNorm();
    const double both = !stands ? along * along : along * own <= 0 ? 0 : std::min(along * along, own * own);
    const double leaning = both < limit ? both / limit : 1.0;
    const double weighed = weight / 256.0 * leaning * leaning * along;
    told.information += weighed * along;
    told.confirmed += weighed * own;
    told.moved += weighed * row.residual * kResidualMetres;
  }
  return told;
}

}  // namespace

WeakMotions weigh_weak_motions(std::span<const PlaneRow> rows, const RobustMoments& robust, double radius,
                               bool stands) noexcept {
  WeakMotions weak;
  weak.equations = plane_equations(robust.moments);
  if (robust.moments.weight == 0) return weak;
  const double weight = static_cast<double>(robust.moments.weight) / 256.0;
  // Unknowns in metres that points move by.
  Vector6 unit;
  unit << 1 / radius, 1 / radius, 1 / radius, 1, 1, 1;
  const Matrix6 a = unit.asDiagonal() * weak.equations.a * unit.asDiagonal();
  Vector6 b = unit.cwiseProduct(weak.equations.b);
  const Eigen6 motions = symmetric_eigen6(a);
  Matrix6 weighed = a;
  weak.held = 1;
  for (int k = 0; k < 6; ++k) {
    double share = std::sqrt(std::max(0.0, motions.values[k]) / weight);
    if (share < kWeak) {
      // Motions of the matrix's own are independent of each other: one is exchanged alone.
      const Vector6 v = motions.vectors.col(k);
      const Told told = told_of(unit.cwiseProduct(v), rows, robust, stands);
      weighed += (told.information - motions.values[k]) * v * v.transpose();
      b += (told.moved - v.dot(b)) * v;
      share = std::sqrt(std::max(0.0, told.confirmed) / weight);
    }
    weak.held = std::min(weak.held, share);
  }
  const Vector6 back = unit.cwiseInverse();
  weak.equations.a = back.asDiagonal() * weighed * back.asDiagonal();
  weak.equations.b = back.cwiseProduct(b);
  return weak;
}

double needed_share(const SlipNoise& noise, double radius, std::size_t rows) noexcept {
  const double slip = kSlip * radius;
  const double fixed = 0.5 * noise.sigma * noise.standing / slip;
  const double random =
      2 * noise.sigma / slip * std::sqrt(noise.alike / static_cast<double>(std::max<std::size_t>(1, rows)));
  return std::clamp(std::sqrt(fixed * fixed + random * random), kFeigned, kAsked);
}

}  // namespace pliant

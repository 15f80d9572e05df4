#include "drivers/model_files/characterisability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/camera/sensor.hpp"
#include "core/detect/symmetric_eigen.hpp"
#include "core/geometry/symmetric_eigen6.hpp"
#include "drivers/model_files/describe_model.hpp"
#include "drivers/model_files/nearest.hpp"

namespace pliant {

namespace {

constexpr std::size_t kPoints = 3000;  // an even sampling of the surface
constexpr double kDistance = 0.8;      // metres, a usual distance of the object
constexpr double kSlip = 0.1;          // of the object's radius
constexpr double kNoiseShare = 0.5;
constexpr double kLeastNeeded = 0.04;
constexpr double kSmoothingSpacings = 2.5;

/// The normal of the surface around point i rather than of its facet: noise of the scan must not count as
/// shape.
Vector3 smoothed_normal(const OrientedCloud& cloud, const NearestPoints& tree, std::size_t i, double radius) {
  std::array<std::uint32_t, 24> nearest{};
  std::array<double, 24> squares{};
  const std::size_t count = tree.nearest(cloud.points[i], nearest, squares);
  Vector3 sum = cloud.normals[i];
  for (std::size_t k = 0; k < count && squares[k] <= radius * radius; ++k)
    if (nearest[k] != i && cloud.normals[nearest[k]].dot(cloud.normals[i]) > 0.5)
      sum += cloud.normals[nearest[k]];
  return unit_or_zero(sum);
}

/// Of the `free` first motions (columns: turn, shift; orthonormal in moved distance) how many are mere
/// shifts.
std::size_t free_shifts(const Matrix6& motions, int free) {
  Matrix6 by_turning = Matrix6::Identity();
  for (int a = 0; a < free; ++a)
    for (int b = 0; b < free; ++b) by_turning(a, b) = motions.col(a).head<3>().dot(motions.col(b).head<3>());
  const Vector6 shares = symmetric_eigen6(by_turning).values;
  std::size_t shifts = 0;
  while (shifts < 6 && shares(static_cast<Eigen::Index>(shifts)) < 0.5) ++shifts;
  return shifts;
}

ModelHeader::Ambiguity name_of(std::size_t free, std::size_t shifts) {
  using enum ModelHeader::Ambiguity;
  const std::size_t turns = free - shifts;
  if (free == 0) return none;
  if (free <= 3 && shifts == 0) return free == 1 ? rotation : sphere;
  if (free == 3 && shifts == 2) return plane;
  if (free == 1 || (free == 2 && turns == 1)) return translation;
  return featureless;
}

}  // namespace

Characterisability characterise(const OrientedCloud& cloud, double spacing) {
  Characterisability result;
  const std::size_t count = std::min(cloud.points.size(), kPoints);
  const NearestPoints tree(cloud.points);
  Vector3 centre = Vector3::Zero();
  for (std::size_t i = 0; i < count; ++i) centre += cloud.points[i] / static_cast<double>(count);
  double square = 0;
  for (std::size_t i = 0; i < count; ++i)
    square += (cloud.points[i] - centre).squaredNorm() / static_cast<double>(count);
  const double radius = std::sqrt(square);

  // How far each motion moves the points along their normals, and by its turn at all (a shift moves all by
  // one).
  Matrix6 along_normal = Matrix6::Zero();
  Matrix3 turned = 1e-9 * Matrix3::Identity();  // points on one line: that turn moves nothing
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 p = (cloud.points[i] - centre) / radius;
    const Vector3 n = smoothed_normal(cloud, tree, i, kSmoothingSpacings * spacing);
    Vector6 row;
    row << cross(p, n), n;
    along_normal += row * row.transpose() / static_cast<double>(count);
    turned += (Matrix3::Identity() * p.squaredNorm() - p * p.transpose()) / static_cast<double>(count);
  }
  // In units of the distance that the points move.
  const SymmetricEigen turns = symmetric_eigen(turned);
  Matrix6 unit = Matrix6::Identity();
  unit.topLeftCorner<3, 3>() = turns.vectors * turns.values.cwiseSqrt().cwiseInverse().asDiagonal();
  const Eigen6 motions = symmetric_eigen6(unit.transpose() * along_normal * unit);
  const Vector6 shares = motions.values.cwiseMax(0.0).cwiseMin(1.0).cwiseSqrt();
  result.measure = shares(0);
  const double noise = SensorDescription().sigma(kDistance);
  result.needed = std::clamp(kNoiseShare * noise / (kSlip * radius), kLeastNeeded, 0.3);

  int free = 0;
  while (free < 6 && shares(free) < result.needed) ++free;
  if (free == 0) return result;
  const std::size_t shifts = free_shifts(motions.vectors, free);
  result.ambiguity = name_of(static_cast<std::size_t>(free), shifts);
  result.reason =
      fmt::format("{} (a slip by {:.1f} mm moves its surface by {:.2f} mm; the sensor needs {:.2f} mm)",
                  describe(result.ambiguity), 1000 * kSlip * radius, 1000 * kSlip * radius * result.measure,
                  1000 * kSlip * radius * result.needed);
  return result;
}

}  // namespace pliant

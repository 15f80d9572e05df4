#include "drivers/model_files/characterisability.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/camera/sensor.hpp"
#include "drivers/model_files/describe_model.hpp"
#include "drivers/model_files/nearest.hpp"

namespace pliant {

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

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

/// Of the motions that are free (columns: turn, shift; orthonormal in moved distance) how many are mere
/// shifts.
std::size_t free_shifts(const Eigen::Matrix<double, 6, Eigen::Dynamic>& free, const Matrix6& moved) {
  const Eigen::Matrix<double, 3, Eigen::Dynamic> turns = free.topRows<3>();
  const Eigen::MatrixXd by_turning = turns.transpose() * moved.topLeftCorner<3, 3>() * turns;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> shares(by_turning);
  std::size_t shifts = 0;
  for (Eigen::Index i = 0; i < shares.eigenvalues().size(); ++i)
    shifts += shares.eigenvalues()(i) < 0.5 ? 1U : 0U;
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

  Matrix6 along_normal = Matrix6::Zero(), moved = Matrix6::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 p = (cloud.points[i] - centre) / radius;
    const Vector3 n = smoothed_normal(cloud, tree, i, kSmoothingSpacings * spacing);
    Vector6 row;
    row << cross(p, n), n;
    along_normal += row * row.transpose() / static_cast<double>(count);
    moved.topLeftCorner<3, 3>() +=
        (Matrix3::Identity() * p.squaredNorm() - p * p.transpose()) / static_cast<double>(count);
  }
  moved.topLeftCorner<3, 3>() += 1e-9 * Matrix3::Identity();  // points on one line: that turn moves nothing
  moved.bottomRightCorner<3, 3>().setIdentity();

  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> motions(along_normal, moved);
  const Vector6 shares = motions.eigenvalues().cwiseMax(0.0).cwiseMin(1.0).cwiseSqrt();
  result.measure = shares(0);
  const double noise = SensorDescription().sigma(kDistance);
  result.needed = std::clamp(kNoiseShare * noise / (kSlip * radius), kLeastNeeded, 0.3);

  Eigen::Index free = 0;
  while (free < 6 && shares(free) < result.needed) ++free;
  if (free == 0) return result;
  const std::size_t shifts = free_shifts(motions.eigenvectors().leftCols(free), moved);
  result.ambiguity = name_of(static_cast<std::size_t>(free), shifts);
  result.reason =
      fmt::format("{} (a slip by {:.1f} mm moves its surface by {:.2f} mm; the sensor needs {:.2f} mm)",
                  describe(result.ambiguity), 1000 * kSlip * radius, 1000 * kSlip * radius * result.measure,
                  1000 * kSlip * radius * result.needed);
  return result;
}

}  // namespace pliant

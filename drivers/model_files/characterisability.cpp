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
/// A free motion is a turn when its axis lies within three times as far from the middle as the points lie
/// from the axis's parallel through it (root mean square): so does that of an arc of 65° and more.
constexpr double kTurnShare = 0.1;

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

/// Motions that the shape does not notice, points in units of its radius about its middle.
struct FreeMotions {
  std::vector<Vector3> shifts;  // directions
  struct Turn {
    Vector3 turn, shift;  // of the middle
  };
  std::vector<Turn> turns;
};

/// The `free` first motions (columns: turn, shift; orthonormal in moved distance), parted into shifts and
/// turns. `turn_of`: a column's head to the turn. The middle of what is seen from one side lies off the axis
/// that it can be turned about, and such a turn shifts the middle too: more, of half a pipe, than it turns
/// it.
FreeMotions free_motions(const Matrix6& motions, int free, const Matrix3& turn_of) {
  Matrix6 by_turning = 2 * Matrix6::Identity();  // those that are not free come last: shares are 1 at most
  for (int a = 0; a < free; ++a)
    for (int b = 0; b < free; ++b) by_turning(a, b) = motions.col(a).head<3>().dot(motions.col(b).head<3>());
  const Eigen6 parts = symmetric_eigen6(by_turning);
  FreeMotions found;
  for (int k = 0; k < free; ++k) {
    const Vector6 motion = motions * parts.vectors.col(k);
    if (parts.values[k] < kTurnShare)
      found.shifts.push_back(unit_or_zero(motion.tail<3>()));
    else
      found.turns.push_back({turn_of * motion.head<3>(), motion.tail<3>()});
  }
  return found;
}

ModelHeader::Ambiguity name_of(const FreeMotions& free) {
  using enum ModelHeader::Ambiguity;
  const std::size_t turns = free.turns.size(), shifts = free.shifts.size();
  if (turns + shifts == 0) return none;
  if (shifts == 0 && turns <= 3) return turns == 1 ? rotation : sphere;
  if (shifts == 2 && turns == 1) return plane;
  if (shifts == 1 && turns <= 1) return translation;
  return featureless;
}

/// The motion in words, with where it goes in the model's frame; `middle` and `radius` as they were measured.
std::string describe_motions(const FreeMotions& free, const Vector3& middle, double radius) {
  const auto direction = [](const Vector3& v) {
    Eigen::Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    const Vector3 d = v[largest] < 0 ? Vector3(-v) : v;
    return fmt::format("({:.2f} {:.2f} {:.2f})", d.x() + 0.0, d.y() + 0.0, d.z() + 0.0);
  };
  std::string text;
  if (free.turns.size() > 1 || free.shifts.size() > 1) return text;  // naming some of them would mislead
  if (free.turns.size() == 1) {
    const auto& [turn, shift] = free.turns.front();
    const Vector3 foot = middle + radius / turn.squaredNorm() * cross(turn, shift);
    text = fmt::format("a turn about the axis through ({:.4f} {:.4f} {:.4f}) m along {}", foot.x(), foot.y(),
                       foot.z(), direction(unit_or_zero(turn)));
  }
  if (free.shifts.size() == 1)
    text += fmt::format("{}a shift along {}", text.empty() ? "" : " and ", direction(free.shifts.front()));
  return text;
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
  if (!(radius > 0)) return result;

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
  const FreeMotions motions_free = free_motions(motions.vectors, free, unit.topLeftCorner<3, 3>());
  result.ambiguity = name_of(motions_free);
  result.motions = describe_motions(motions_free, centre, radius);
  result.reason =
      fmt::format("{} (a slip by {:.1f} mm moves its surface by {:.2f} mm; the sensor needs {:.2f} mm)",
                  describe(result.ambiguity), 1000 * kSlip * radius, 1000 * kSlip * radius * result.measure,
                  1000 * kSlip * radius * result.needed);
  return result;
}

}  // namespace pliant

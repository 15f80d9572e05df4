#include "core/capture/first_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace pliant {

namespace {

constexpr double kBelowTable = 0.008;               // metres of the cube below the table
constexpr std::int32_t kUprightEnough = 16384 / 6;  // Q14

/// The plane that the target stands on: of the planes not far below it the one most upright in the picture;
/// where none is (the camera looks straight down), the nearest. Null when there is none.
const BackgroundPlane* table_of(std::span<const ViewPoint> points, std::span<const BackgroundPlane> planes,
                                std::int32_t half) noexcept {
  const BackgroundPlane* table = nullptr;
  std::int32_t nearest = half, uprightness = kUprightEnough;
  for (const BackgroundPlane& plane : planes) {
    std::int32_t least = 1 << 20;
    for (const ViewPoint& p : points) least = std::min(least, plane.height({p.x, p.y, p.z}));
    if (least > half) continue;
    const bool upright = -plane.normal.y > uprightness;
    if (!upright && (uprightness > kUprightEnough || least >= nearest)) continue;
    if (upright) uprightness = -plane.normal.y;
    nearest = least;
    table = &plane;
  }
  return table;
}

}  // namespace

FirstView place_first_view(std::span<const ViewPoint> points, const Target& target,
                           std::span<const BackgroundPlane> planes, std::int32_t half_units) noexcept {
  FirstView first;
  const BackgroundPlane* const table = table_of(points, planes, half_units);
  Vector3 up(0, -1, 0);
  if (table != nullptr) up = Vector3(table->normal.x, table->normal.y, table->normal.z) / 16384.0;
  up.normalize();
  Vector3 right = Vector3(1, 0, 0) - up.x() * up;
  right.normalize();
  const Vector3 away = up.cross(right);
  // The bounding box along these axes.
  Vector3 low(1e9, 1e9, 1e9), high(-1e9, -1e9, -1e9);
  for (const ViewPoint& point : points) {
    const Vector3 p = Vector3(point.x, point.y, point.z) / kUnitsPerMetre;
    const Vector3 q(right.dot(p), away.dot(p), up.dot(p));
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const double half = half_units / kUnitsPerMetre;
  Vector3 middle = 0.5 * (low + high);
  const Vector3 seen = high - low;
  if (seen.maxCoeff() > 2 * half) {
    // Where it is larger than the cube, its front middle counts.
    const Vector3 m = Vector3(target.middle.x, target.middle.y, target.middle.z) / kUnitsPerMetre;
    middle = Vector3(right.dot(m), away.dot(m), up.dot(m));
    first.too_large = true;
  } else {
    // As deep as it is wide, for all that the first view tells.
    middle.y() = low.y() + 0.5 * std::clamp(seen.x(), seen.y(), 2 * half);
  }
  first.table_height = -2 * half;
  if (table != nullptr) {
    const double plane = table->offset / kUnitsPerMetre;
    middle.z() = std::min(middle.z(), plane + half - kBelowTable);
    if (seen.z() < 2 * half - kBelowTable) middle.z() = plane + half - kBelowTable;
    first.table_height = plane - middle.z();
  }
  first.pose.rotation.col(0) = right;
  first.pose.rotation.col(1) = away;
  first.pose.rotation.col(2) = up;
  first.pose.rotation = orthonormalised(first.pose.rotation);
  first.pose.translation = first.pose.rotation * middle;
  return first;
}

}  // namespace pliant

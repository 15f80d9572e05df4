// Small rigid motions: rotation vector (radians) first, then translation (metres), both about a stated
// centre.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The transform that turns and moves by `x` about `centre`.
[[nodiscard]] inline RigidTransform motion_about(const Vector6& x, const Vector3& centre) noexcept {
  RigidTransform step;
  step.rotation = rotation_from_small_vector(x.head<3>());
  step.translation = centre + Vector3(x.tail<3>()) - step.rotation * centre;
  return step;
}

/// What turns `pose` into `target`, about `centre` (in the frame that they lead to).
[[nodiscard]] inline Vector6 motion_between(const RigidTransform& target, const RigidTransform& pose,
                                            const Vector3& centre) noexcept {
  const RigidTransform step = target * pose.inverse();
  Vector6 x;
  x.head<3>() = small_vector_from_rotation(step.rotation);
  x.tail<3>() = step * centre - centre;
  return x;
}

/// Rotation vector that turns b into a, exact to second order: half of the skew part of a·bᵀ.
[[nodiscard]] inline Vector3 turn_between(const Matrix3& a, const Matrix3& b) noexcept {
  Vector3 turn = Vector3::Zero();
  for (int k = 0; k < 3; ++k) turn += 0.5 * Vector3(b.col(k)).cross(Vector3(a.col(k)));
  return turn;
}

}  // namespace pliant

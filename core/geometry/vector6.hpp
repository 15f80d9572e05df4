// Small rigid motions: rotation vector (radians) first, then translation (metres), both about a stated
// centre.
#pragma once

#include <Eigen/Core>

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

}  // namespace pliant

// Rigid transforms in double precision. No libm call but sqrt: the same bits on every platform.
#pragma once

#include <Eigen/Core>

namespace pliant {

using Vector3 = Eigen::Matrix<double, 3, 1>;
using Matrix3 = Eigen::Matrix<double, 3, 3>;
/// Three floats, tightly packed: positions in files, messages and results. Metres.
struct Point3f {
  float x = 0, y = 0, z = 0;
};
[[nodiscard]] inline Vector3 to_vector(const Point3f& p) noexcept {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}
[[nodiscard]] inline Point3f to_point(const Vector3& p) noexcept {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

/// Unit quaternion, w first, w >= 0.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

/// to <- from: p_to = rotation * p_from + translation. Metres.
struct RigidTransform {
  Matrix3 rotation = Matrix3::Identity();
  Vector3 translation = Vector3::Zero();

  [[nodiscard]] Vector3 operator*(const Vector3& p) const noexcept { return rotation * p + translation; }
  [[nodiscard]] RigidTransform operator*(const RigidTransform& b) const noexcept {
    return {rotation * b.rotation, rotation * b.translation + translation};
  }
  [[nodiscard]] RigidTransform inverse() const noexcept {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }
};

/// Rotation by the vector `w` (axis times angle, radians) in Cayley's form: exact rotation matrix, equal to
/// the exponential to third order in |w|. Any |w| gives a proper rotation (of 2·atan(|w|/2)).
[[nodiscard]] Matrix3 rotation_from_small_vector(const Vector3& w) noexcept;
/// The inverse of rotation_from_small_vector for rotations below 180°.
[[nodiscard]] Vector3 small_vector_from_rotation(const Matrix3& rotation) noexcept;
/// The nearest rotation to a matrix that is nearly one (three Newton steps).
[[nodiscard]] Matrix3 orthonormalised(const Matrix3& m) noexcept;
[[nodiscard]] Quaternion quaternion_from_rotation(const Matrix3& rotation) noexcept;
[[nodiscard]] Matrix3 rotation_from_quaternion(const Quaternion& q) noexcept;
/// Cosine of the angle of a rotation: (trace − 1) / 2.
[[nodiscard]] inline double cos_angle(const Matrix3& r) noexcept {
  return 0.5 * (r(0, 0) + r(1, 1) + r(2, 2) - 1.0);
}

}  // namespace pliant

#include "core/geometry/rigid_transform.hpp"

#include <cmath>

namespace pliant {

Matrix3 rotation_from_small_vector(const Vector3& w) noexcept {
  const Vector3 h = 0.5 * w;
  const double n = h.x() * h.x() + h.y() * h.y() + h.z() * h.z();
  const double s = 1.0 / (1.0 + n);
  return rotation_from_quaternion(
      {std::sqrt(s), h.x() * std::sqrt(s), h.y() * std::sqrt(s), h.z() * std::sqrt(s)});
}

Vector3 small_vector_from_rotation(const Matrix3& rotation) noexcept {
  const Quaternion q = quaternion_from_rotation(rotation);
  const double w = q.w > 1e-9 ? q.w : 1e-9;
  return Vector3(q.x, q.y, q.z) * (2.0 / w);
}

Matrix3 orthonormalised(const Matrix3& m) noexcept {
  Matrix3 r = m;
  for (int i = 0; i < 3; ++i) {
    const Matrix3 error = r.transpose() * r;
    const Matrix3 step = 1.5 * Matrix3::Identity() - 0.5 * error;
    r = Matrix3(r * step);
  }
  return r;
}

Quaternion quaternion_from_rotation(const Matrix3& m) noexcept {
  const double trace = m(0, 0) + m(1, 1) + m(2, 2);
  double w, x, y, z;
  if (trace > 0) {
    const double s = 2.0 * std::sqrt(trace + 1.0);
    w = 0.25 * s;
    x = (m(2, 1) - m(1, 2)) / s;
    y = (m(0, 2) - m(2, 0)) / s;
    z = (m(1, 0) - m(0, 1)) / s;
  } else if (m(0, 0) > m(1, 1) && m(0, 0) > m(2, 2)) {
    const double s = 2.0 * std::sqrt(1.0 + m(0, 0) - m(1, 1) - m(2, 2));
    w = (m(2, 1) - m(1, 2)) / s;
    x = 0.25 * s;
    y = (m(0, 1) + m(1, 0)) / s;
    z = (m(0, 2) + m(2, 0)) / s;
  } else if (m(1, 1) > m(2, 2)) {
    const double s = 2.0 * std::sqrt(1.0 + m(1, 1) - m(0, 0) - m(2, 2));
    w = (m(0, 2) - m(2, 0)) / s;
    x = (m(0, 1) + m(1, 0)) / s;
    y = 0.25 * s;
    z = (m(1, 2) + m(2, 1)) / s;
  } else {
    const double s = 2.0 * std::sqrt(1.0 + m(2, 2) - m(0, 0) - m(1, 1));
    w = (m(1, 0) - m(0, 1)) / s;
    x = (m(0, 2) + m(2, 0)) / s;
    y = (m(1, 2) + m(2, 1)) / s;
    z = 0.25 * s;
  }
  const double norm = std::sqrt(w * w + x * x + y * y + z * z);
  const double scale = (w < 0 ? -1.0 : 1.0) / norm;
  return {w * scale, x * scale, y * scale, z * scale};
}

Matrix3 rotation_from_quaternion(const Quaternion& q) noexcept {
  Matrix3 r;
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  r << 1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy),  //
      2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx),   //
      2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy);
  return r;
}

}  // namespace pliant

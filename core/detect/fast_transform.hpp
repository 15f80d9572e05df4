// Rigid transforms in single precision, for the thousands of points of a verification.
#pragma once

#include "core/camera/sensor.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// A rigid transform in single precision, for thousands of points.
struct FastTransform {
  float r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  float t[3] = {0, 0, 0};

  FastTransform() noexcept = default;
  explicit FastTransform(const RigidTransform& pose) noexcept {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) r[3 * i + j] = static_cast<float>(pose.rotation(i, j));
      t[i] = static_cast<float>(pose.translation(i));
    }
  }
  /// In double precision, a rotation to single precision.
  [[nodiscard]] RigidTransform rigid() const noexcept {
    RigidTransform pose;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) pose.rotation(i, j) = static_cast<double>(r[3 * i + j]);
      pose.translation(i) = static_cast<double>(t[i]);
    }
    return pose;
  }
  [[nodiscard]] Point3f point(const Point3f& p) const noexcept {
    return {r[0] * p.x + r[1] * p.y + r[2] * p.z + t[0], r[3] * p.x + r[4] * p.y + r[5] * p.z + t[1],
            r[6] * p.x + r[7] * p.y + r[8] * p.z + t[2]};
  }
  /// Unit vector from Q14.
  [[nodiscard]] Point3f direction(const Normal16& n) const noexcept {
    constexpr float kQ14 = 1.0F / 16384;
    const float x = static_cast<float>(n.x) * kQ14, y = static_cast<float>(n.y) * kQ14,
                z = static_cast<float>(n.z) * kQ14;
    return {r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z, r[6] * x + r[7] * y + r[8] * z};
  }
};

[[nodiscard]] inline float dot(const Point3f& a, const Point3f& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// σ of a reading at depth z, metres.
[[nodiscard]] inline float sigma_at(const SensorDescription& sensor, float z) noexcept {
  const float beyond = z - 0.4F;
  return static_cast<float>(sensor.noise_floor) + static_cast<float>(sensor.noise_growth) * beyond * beyond;
}

}  // namespace pliant

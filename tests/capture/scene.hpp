// Small scenes before a camera, drawn without noise: a table, and what stands or moves on it.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/geometry/rigid_transform.hpp"

namespace pliant::test {

inline Intrinsics small_camera() {
  return {320, 240, 285, 285, 160, 120, 1000};
}

/// A picture of what `nearest` says: the depth (metres) along a ray whose third component is 1, 0 where there
/// is nothing.
class Picture {
 public:
  explicit Picture(const std::function<double(const Vector3&)>& nearest, std::int64_t number = 0) {
    const Intrinsics camera = small_camera();
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const double z = nearest({(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1});
        depth_.push_back(static_cast<std::uint16_t>(std::floor(1000 * z + 0.5)));
      }
    frame_ = {depth_.data(), camera.width, camera.height, camera.width, number * 33333, number};
  }
  [[nodiscard]] const DepthFrame& frame() const { return frame_; }

 private:
  std::vector<std::uint16_t> depth_;
  DepthFrame frame_;
};

/// Depth of the plane normal · p = offset along `ray`, or far away.
inline double plane_depth(const Vector3& ray, const Vector3& normal, double offset) {
  const double along = normal.dot(ray);
  return along * offset > 0 ? offset / along : 1e3;
}
/// A table 0.25 m below the camera's axis at 0.7 m, looked at from 35° above.
inline double table_depth(const Vector3& ray) {
  const Vector3 up(0, -0.8191520, -0.5735764);
  const double z = plane_depth(ray, up, up.dot(Vector3(0, 0.08, 0.7)));
  return z < 1.9 ? z : 0;
}
inline double ball_depth(const Vector3& ray, const Vector3& centre, double radius) {
  const double a = ray.squaredNorm(), b = ray.dot(centre), c = centre.squaredNorm() - radius * radius;
  const double root = b * b - a * c;
  return root > 0 ? (b - std::sqrt(root)) / a : 1e3;
}
inline double nearer(double a, double b) {
  return a == 0 || (b > 0 && b < a) ? (b < 1e2 ? b : 0) : a;
}

}  // namespace pliant::test

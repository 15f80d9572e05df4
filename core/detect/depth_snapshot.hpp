// What detection keeps of a frame: the cleaned depth at a reduced size, with normals on a coarser lattice, so
// that its later slices do not depend on the frame.
#pragma once

#include <cstdint>
#include <span>

#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/camera/surface.hpp"
#include "core/memory/row_major.hpp"
#include "core/memory/workspace.hpp"

namespace pliant {

class DepthSnapshot {
 public:
  /// At most this many pixels: 320×240 and a little.
  static constexpr int kMostPixels = 80000;
  /// Normals stand on every second pixel of every second row.
  static constexpr int kNormalStep = 2;

  void lay_out(Workspace& workspace, const Intrinsics& camera) noexcept;
  void start(const Intrinsics& camera, const SensorDescription& sensor) noexcept;

  /// Copies every n-th pixel of the surface (which is smoothed: it stands for its neighbourhood).
  void take(const Surface& surface) noexcept;
  /// Computes the normals of lattice rows [first, last): least-squares planes of the depth in a window of
  /// about `metres` to each side, within the reading's own surface.
  void compute_normals(int first, int last, double metres) noexcept;

  /// Marks (Normal16::pad = 1) the lattice points from which the surface goes on as one plane for `metres` to
  /// at least three of four sides: walls, tables. After all normals.
  void mark_plain(double metres) noexcept;

  [[nodiscard]] int width() const noexcept { return camera_.width; }
  [[nodiscard]] int height() const noexcept { return camera_.height; }
  [[nodiscard]] int lattice_width() const noexcept { return (camera_.width + kNormalStep - 1) / kNormalStep; }
  [[nodiscard]] int lattice_height() const noexcept {
    return (camera_.height + kNormalStep - 1) / kNormalStep;
  }
  /// Intrinsics of the reduced picture.
  [[nodiscard]] const Intrinsics& camera() const noexcept { return camera_; }
  [[nodiscard]] const SensorDescription& sensor() const noexcept { return sensor_; }

  /// 1/8 mm, 0 = none. No bounds check.
  [[nodiscard]] std::uint16_t depth(int u, int v) const noexcept {
    return depth_[row_major(v, camera_.width, u)];
  }
  /// Normal (towards the camera, Q14) of the lattice point nearest before pixel (u, v); zero where there is
  /// none.
  [[nodiscard]] const Normal16& normal(int u, int v) const noexcept {
    return normals_[row_major(v / kNormalStep, lattice_width(), u / kNormalStep)];
  }
  /// Vertex of a pixel, metres, camera frame.
  [[nodiscard]] Point3f vertex(int u, int v) const noexcept {
    const float z = static_cast<float>(depth(u, v)) * 0.000125F;
    return {(static_cast<float>(u) - cx_) * inverse_fx_ * z, (static_cast<float>(v) - cy_) * inverse_fy_ * z,
            z};
  }
  /// Pixel of a camera-frame point with z > 0; false outside the picture.
  [[nodiscard]] bool project(const Point3f& p, int& u, int& v) const noexcept {
    const float inverse = 1.0F / p.z;
    const float x = fx_ * p.x * inverse + cx_half_, y = fy_ * p.y * inverse + cy_half_;
    if (!(x >= 0 && y >= 0 && x < width_f_ && y < height_f_)) return false;
    u = static_cast<int>(x);
    v = static_cast<int>(y);
    return true;
  }

 private:
  [[nodiscard]] bool fit_normal(int u, int v, double metres, Normal16& out) const noexcept;

  Intrinsics camera_;
  SensorDescription sensor_;
  int factor_ = 1;
  float fx_ = 1, fy_ = 1, cx_ = 0, cy_ = 0, inverse_fx_ = 1, inverse_fy_ = 1;
  float cx_half_ = 0, cy_half_ = 0, width_f_ = 0, height_f_ = 0;
  std::span<std::uint16_t> depth_;
  std::span<Normal16> normals_;
};

/// The reduced picture's intrinsics.
[[nodiscard]] Intrinsics reduced_intrinsics(const Intrinsics& camera) noexcept;

}  // namespace pliant

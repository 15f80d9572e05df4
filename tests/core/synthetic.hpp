// Scenes for tests of the core: depth pictures rendered from meshes, and models built of them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/memory/row_major.hpp"
#include "core/memory/workspace.hpp"
#include "drivers/geometry_files/geometry.hpp"
#include "drivers/model_files/model_file.hpp"

namespace pliant::synthetic {

/// 320×240, 60° wide, millimetres.
[[nodiscard]] Intrinsics small_camera();

/// A superellipsoid of about 24 × 18 × 12 cm with bumps: no symmetry. Wound outward.
[[nodiscard]] Geometry bumpy_body();
/// Two boxes with rounded edges along x that meet at the origin, with bumps: bends there.
[[nodiscard]] Geometry two_part_bar();
[[nodiscard]] ModelFile model_of(const Geometry& geometry, double spacing = 0.006);

/// A rotation of `angle` radians about `axis` (any length).
[[nodiscard]] Matrix3 turn(const Vector3& axis, double angle);
[[nodiscard]] RigidTransform pose_at(const Vector3& where, const Vector3& axis = {0, 1, 0}, double angle = 0);

/// The angle between two rotations, degrees.
[[nodiscard]] double degrees_between(const Matrix3& a, const Matrix3& b);

/// A depth picture that can be drawn into: nearest wins.
class Picture {
 public:
  explicit Picture(const Intrinsics& camera);

  /// Triangles seen from inside are drawn, too.
  void draw(const Geometry& mesh, const RigidTransform& pose);
  /// As draw() with every vertex moved by `move` in the model frame first.
  void draw(const Geometry& mesh, const RigidTransform& pose,
            const std::function<Vector3(const Vector3&)>& move);
  /// A wall that faces the camera.
  void wall(double depth);
  /// A rectangle of pixels at one depth, before what is there.
  void block(int u0, int v0, int u1, int v1, double depth);
  /// Normally distributed noise, the same for the same seed.
  void shake(double sigma, unsigned seed);

  /// The drawn depth in raw units; valid until the next change.
  [[nodiscard]] DepthFrame frame(std::int64_t number = 0);
  [[nodiscard]] double depth(int u, int v) const { return depth_[row_major(v, camera_.width, u)]; }

 private:
  Intrinsics camera_;
  std::vector<double> depth_;  // metres, 0 none
  std::vector<std::uint16_t> raw_;
};

/// A workspace with memory of its own.
class OwnedWorkspace {
 public:
  explicit OwnedWorkspace(std::size_t bytes);
  [[nodiscard]] Workspace& get() { return workspace_; }
  [[nodiscard]] static std::span<std::byte> aligned(std::vector<std::byte>& storage, std::size_t bytes);

 private:
  std::vector<std::byte> storage_;
  Workspace workspace_;
};

}  // namespace pliant::synthetic

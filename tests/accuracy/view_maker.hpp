// Single simulated depth pictures of a mesh among clutter.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "drivers/geometry_files/geometry.hpp"
#include "drivers/simulated/disparity_image.hpp"
#include "drivers/simulated/structure_sensor.hpp"

namespace pliant {

inline constexpr double kSize = 0.3;  ///< metres, the target's diagonal
inline Intrinsics structure_camera() {
  Intrinsics camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 570;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.depth_scale = 1000;
  return camera;
}

struct ScaledMesh {
  std::vector<Vector3> vertices;  // around the middle, metres
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

inline ScaledMesh scaled(const Geometry& geometry, double diagonal) {
  Vector3 low(1e9, 1e9, 1e9), high(-1e9, -1e9, -1e9);
  for (const Point3f& p : geometry.vertices)
    for (int k = 0; k < 3; ++k) {
      const double x = static_cast<double>(k == 0 ? p.x : k == 1 ? p.y : p.z);
      low(k) = std::min(low(k), x);
      high(k) = std::max(high(k), x);
    }
  const double scale = diagonal / (high - low).norm();
  const Vector3 middle = (high + low) / 2;
  ScaledMesh mesh;
  for (const Point3f& p : geometry.vertices)
    mesh.vertices.emplace_back(scale * (static_cast<double>(p.x) - middle.x()),
                               scale * (static_cast<double>(p.y) - middle.y()),
                               scale * (static_cast<double>(p.z) - middle.z()));
  mesh.triangles = geometry.triangles;
  return mesh;
}

inline ScaledMesh ball(double radius) {
  constexpr int kRings = 24, kSides = 32;
  ScaledMesh mesh;
  for (int i = 0; i <= kRings; ++i)
    for (int j = 0; j < kSides; ++j) {
      const double a = M_PI * i / kRings, b = 2 * M_PI * j / kSides;
      mesh.vertices.emplace_back(radius * std::sin(a) * std::cos(b), radius * std::sin(a) * std::sin(b),
                                 radius * std::cos(a));
    }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(i * kSides + j % kSides); };
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSides; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

/// A rotation spread evenly over all.
inline Matrix3 random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  double q[4], square = 0;
  for (double& x : q) {
    x = normal(random);
    square += x * x;
  }
  for (double& x : q) x /= std::sqrt(square);
  return rotation_from_quaternion({q[0], q[1], q[2], q[3]});
}

inline std::vector<Vector3> placed(const ScaledMesh& mesh, const RigidTransform& pose) {
  std::vector<Vector3> out;
  out.reserve(mesh.vertices.size());
  for (const Vector3& v : mesh.vertices) out.push_back(pose * v);
  return out;
}

struct View {
  std::vector<std::uint16_t> with, without;  ///< depth pictures, millimetres
  RigidTransform pose;                       ///< camera <- target
  double seen = 0;                           ///< share of the target's facing vertices in sight
  double clutter = 0;                        ///< share of the readings that are none of the target's
};

class ViewMaker {
 public:
  ViewMaker(const ScaledMesh& target, const std::vector<ScaledMesh>& others)
      : target_(target), others_(others) {}

  /// One view; false when too little of the target is in sight or it fills the picture.
  bool make(std::uint64_t seed, View& view) {
    std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
    std::uniform_real_distribution<double> unit(0, 1);
    const double z = 0.5 + 0.7 * unit(random);
    const double margin = 0.5 * kSize * camera_.fx / z;
    const double u = margin + (camera_.width - 2 * margin) * unit(random),
                 v = margin + (camera_.height - 2 * margin) * unit(random);
    view.pose.rotation = random_rotation(random);
    view.pose.translation = Vector3((u - camera_.cx) * z / camera_.fx, (v - camera_.cy) * z / camera_.fy, z);
    background_.clear();
    // A table that leans away from the camera and a wall, both beyond the target.
    background_.draw_plane(Vector3(0, 0, 1), z + 0.3 + 0.6 * unit(random), everywhere, nullptr);
    const double lean = 0.3 + 0.5 * unit(random);
    background_.draw_plane(Vector3(0, std::cos(lean), std::sin(lean)),
                           (z + 0.25) * std::sin(lean) + 0.2 * std::cos(lean), everywhere, nullptr);
    for (int k = 0; k < 6; ++k) {
      const ScaledMesh& mesh = others_[random() % others_.size()];
      RigidTransform pose;
      pose.rotation = random_rotation(random);
      const double depth = z - 0.15 + 0.4 * unit(random);
      pose.translation = Vector3((unit(random) - 0.5) * 560 / camera_.fx * depth,
                                 (unit(random) - 0.5) * 420 / camera_.fy * depth, std::max(depth, 0.45));
      background_.draw(placed(mesh, pose), mesh.triangles, {});
    }
    scene_.copy_from(background_);
    const std::vector<Vector3> vertices = placed(target_, view.pose);
    std::vector<std::uint8_t> facing(vertices.size(), 0);
    scene_.draw(vertices, target_.triangles, facing);
    std::size_t faces = 0, sees = 0, changed = 0, drawn = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (facing[i] != 0) {
        ++faces;
        sees += scene_.sees(vertices[i], 0.005) ? 1U : 0U;
      }
    for (std::size_t i = 0; i < scene_.pixels().size(); ++i) {
      drawn += scene_.pixels()[i] != 0 ? 1U : 0U;
      changed += scene_.pixels()[i] != background_.pixels()[i] ? 1U : 0U;
    }
    view.seen = static_cast<double>(sees) / static_cast<double>(std::max<std::size_t>(faces, 1));
    view.clutter = 1 - static_cast<double>(changed) / static_cast<double>(std::max<std::size_t>(drawn, 1));
    if (view.seen < 0.6 || view.clutter < 0.5) return false;
    simulated::StructureSensor sensor(camera_, SensorDescription(), seed);
    view.with.resize(scene_.pixels().size());
    view.without.resize(scene_.pixels().size());
    sensor.measure(scene_, 0, view.with);
    sensor.measure(background_, 0, view.without);
    return true;
  }

 private:
  static bool everywhere(const Vector3&, const void*) { return true; }

  const ScaledMesh& target_;
  const std::vector<ScaledMesh>& others_;
  Intrinsics camera_ = structure_camera();
  simulated::DisparityImage scene_{camera_}, background_{camera_};
};

/// The mesh's vertices and triangles as a file would give them.
inline Geometry geometry_of(const ScaledMesh& mesh) {
  Geometry geometry;
  for (const Vector3& v : mesh.vertices) geometry.vertices.push_back(to_point(v));
  geometry.triangles = mesh.triangles;
  return geometry;
}

}  // namespace pliant

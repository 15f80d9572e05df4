// Plain things of about an object's size, and pictures of them: what must not be taken for the object.
#pragma once

#include <Eigen/Eigenvalues>

#include "tests/accuracy/view_maker.hpp"

namespace pliant {

enum class PlainShape : std::uint8_t { ball, ellipsoid, box, cylinder, plate };
inline constexpr PlainShape kPlainShapes[] = {PlainShape::ball, PlainShape::ellipsoid, PlainShape::box,
                                              PlainShape::cylinder, PlainShape::plate};
inline const char* name_of(PlainShape shape) {
  constexpr const char* kNames[] = {"ball", "ellipsoid", "box", "cylinder", "plate"};
  return kNames[static_cast<int>(shape)];
}

/// Half of the target's extents along its principal axes, the longest first.
inline Vector3 half_extents(const ScaledMesh& mesh) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Vector3& v : mesh.vertices) mean += Eigen::Vector3d(v.x(), v.y(), v.z());
  mean /= static_cast<double>(mesh.vertices.size());
  for (const Vector3& v : mesh.vertices) {
    const Eigen::Vector3d d = Eigen::Vector3d(v.x(), v.y(), v.z()) - mean;
    spread += d * d.transpose();
  }
  const Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  Vector3 half;
  for (int k = 0; k < 3; ++k) {
    double low = 1e9, high = -1e9;
    for (const Vector3& v : mesh.vertices) {
      const double x = axes.col(2 - k).dot(Eigen::Vector3d(v.x(), v.y(), v.z()));
      low = std::min(low, x);
      high = std::max(high, x);
    }
    half(k) = (high - low) / 2;
  }
  return half;
}

/// A tube along x, closed, of 1 around and 1 either way.
inline ScaledMesh unit_cylinder() {
  constexpr int kSides = 48;
  ScaledMesh mesh;
  for (int end = -1; end <= 1; end += 2)
    for (int j = 0; j < kSides; ++j)
      mesh.vertices.emplace_back(end, std::cos(2 * M_PI * j / kSides), std::sin(2 * M_PI * j / kSides));
  mesh.vertices.emplace_back(-1, 0, 0);
  mesh.vertices.emplace_back(1, 0, 0);
  for (std::uint32_t j = 0; j < kSides; ++j) {
    const std::uint32_t next = (j + 1) % kSides;
    mesh.triangles.push_back({j, next, kSides + next});
    mesh.triangles.push_back({j, kSides + next, kSides + j});
    mesh.triangles.push_back({2 * kSides, next, j});
    mesh.triangles.push_back({2 * kSides + 1, kSides + j, kSides + next});
  }
  return mesh;
}

inline ScaledMesh unit_box() {
  ScaledMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.emplace_back((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline ScaledMesh plain_mesh(PlainShape shape, const Vector3& half) {
  ScaledMesh mesh = shape == PlainShape::cylinder                            ? unit_cylinder()
                    : shape == PlainShape::box || shape == PlainShape::plate ? unit_box()
                                                                             : ball(1);
  const double round = std::cbrt(half.x() * half.y() * half.z()), across = std::sqrt(half.y() * half.z());
  for (Vector3& v : mesh.vertices) {
    const Vector3 scale = shape == PlainShape::ball       ? Vector3(round, round, round)
                          : shape == PlainShape::cylinder ? Vector3(half.x(), across, across)
                          : shape == PlainShape::plate    ? Vector3(half.x(), half.y(), 0.01)
                                                          : half;
    v = Vector3(v.x() * scale.x(), v.y() * scale.y(), v.z() * scale.z());
  }
  return mesh;
}

/// A picture of such a thing, of 0.7 to 1.2 times the target's extents, turned at random before a wall.
inline std::vector<std::uint16_t> picture_like(const ScaledMesh& target, PlainShape shape, std::uint64_t seed,
                                               simulated::DisparityImage& image) {
  const Intrinsics camera = structure_camera();
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  std::uniform_real_distribution<double> unit(0, 1);
  const double scale = 0.7 + 0.5 * unit(random), z = 0.5 + 0.7 * unit(random);
  const ScaledMesh mesh = plain_mesh(shape, half_extents(target) * scale);
  RigidTransform pose;
  pose.rotation = random_rotation(random);
  pose.translation = Vector3(0.2 * (unit(random) - 0.5) * z, 0.2 * (unit(random) - 0.5) * z, z);
  image.clear();
  image.draw_plane(
      Vector3(0, 0, 1), z + 0.3 + 0.6 * unit(random), [](const Vector3&, const void*) { return true; },
      nullptr);
  image.draw(placed(mesh, pose), mesh.triangles, {});
  std::vector<std::uint16_t> picture(image.pixels().size());
  simulated::StructureSensor(camera, SensorDescription(), seed).measure(image, 0, picture);
  return picture;
}

}  // namespace pliant

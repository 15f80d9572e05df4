// Objects that the simulated sensor does not bring itself.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/model_files/mesh.hpp"
#include "drivers/model_files/mesh_normals.hpp"

namespace pliant::test {

inline Geometry with_normals(const Mesh& mesh) {
  const auto put = [](const Vector3& v, std::vector<Point3f>& to) { to.push_back(to_point(v)); };
  Geometry geometry;
  for (const Vector3& v : mesh.vertices) put(v, geometry.vertices);
  for (const Vector3& n : vertex_normals(mesh)) put(n, geometry.normals);
  geometry.triangles = mesh.triangles;
  return geometry;
}

/// Of `rings` + 1 rings of `sides` vertices from the bottom up; the first and the last are points.
inline std::vector<Triangle> ring_triangles(int rings, int sides) {
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * sides + j % sides); };
  std::vector<Triangle> triangles;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sides; ++j) {
      if (i > 0) triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      if (i + 1 < rings) triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return triangles;
}

/// Something that stands out: its angle and height above the ground, and how far.
struct Lug {
  double angle, above, height;
};

/// A bottle 26 cm tall, a surface of revolution but for `lugs`.
inline Geometry bottle(std::span<const Lug> lugs) {
  constexpr int kRings = 120, kSides = 180;
  Mesh mesh;
  for (int i = 0; i <= kRings; ++i) {
    const double t = static_cast<double>(i) / kRings, z = 0.26 * t;
    // Body, shoulder, neck; closed at both ends.
    double radius = t < 0.6   ? 0.045
                    : t < 0.8 ? 0.045 - 0.03 * (0.5 - 0.5 * std::cos(M_PI * (t - 0.6) / 0.2))
                              : 0.015;
    radius *= std::sqrt(std::min({1.0, t / 0.02, (1 - t) / 0.02}));
    for (int j = 0; j < kSides; ++j) {
      const double angle = 2 * M_PI * j / kSides;
      double lug = 0;
      for (const auto& [at, above, height] : lugs) {
        const double aside = std::remainder(angle - at, 2 * M_PI) * 0.045, up = z - above;
        lug += height * std::exp(-(aside * aside + up * up) / (2 * 0.009 * 0.009));
      }
      mesh.vertices.emplace_back((radius + lug) * std::cos(angle), (radius + lug) * std::sin(angle), z);
    }
  }
  mesh.triangles = ring_triangles(kRings, kSides);
  return with_normals(mesh);
}

/// All but three lugs of it is a surface of revolution: of any side at least one is seen.
inline Geometry bottle_with_lugs() {
  return bottle(std::array{Lug{-1.4, 0.09, 0.012}, Lug{0.5, 0.11, 0.010}, Lug{2.8, 0.07, 0.012}});
}

/// Nothing tells how it is turned about its axis.
inline Geometry plain_bottle() {
  return bottle({});
}

/// A ball of 16 cm.
inline Geometry ball() {
  constexpr int kRings = 90, kSides = 180;
  constexpr double kRadius = 0.08;
  Mesh mesh;
  for (int i = 0; i <= kRings; ++i)
    for (int j = 0; j < kSides; ++j) {
      const double down = M_PI * i / kRings, angle = 2 * M_PI * j / kSides, r = kRadius * std::sin(down);
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), kRadius * (1 - std::cos(down)));
    }
  mesh.triangles = ring_triangles(kRings, kSides);
  return with_normals(mesh);
}

}  // namespace pliant::test

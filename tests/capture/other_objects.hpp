// Objects that the simulated sensor does not bring itself.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/model_files/mesh.hpp"
#include "drivers/model_files/mesh_normals.hpp"

namespace pliant::test {

inline Geometry with_normals(const Mesh& mesh) {
  const auto put = [](const Vector3& v, std::vector<Point3f>& to) {
    to.push_back({static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
  };
  Geometry geometry;
  for (const Vector3& v : mesh.vertices) put(v, geometry.vertices);
  for (const Vector3& n : vertex_normals(mesh)) put(n, geometry.normals);
  geometry.triangles = mesh.triangles;
  return geometry;
}

/// A bottle 26 cm tall, of which all but three lugs is a surface of revolution.
inline Geometry bottle_with_lugs() {
  constexpr int kRings = 120, kSides = 180;
  // Angle, height above the ground and height of each lug: of any side at least one is seen.
  constexpr std::array<std::array<double, 3>, 3> kLugs = {
      {{-1.4, 0.09, 0.012}, {0.5, 0.11, 0.010}, {2.8, 0.07, 0.012}}};
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
      for (const auto& [at, above, height] : kLugs) {
        const double aside = std::remainder(angle - at, 2 * M_PI) * 0.045, up = z - above;
        lug += height * std::exp(-(aside * aside + up * up) / (2 * 0.009 * 0.009));
      }
      mesh.vertices.emplace_back((radius + lug) * std::cos(angle), (radius + lug) * std::sin(angle), z);
    }
  }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(i * kSides + j % kSides); };
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSides; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      if (i + 1 < kRings) mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return with_normals(mesh);
}

}  // namespace pliant::test

#include "drivers/simulated/surface_nets.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "drivers/geometry_files/surface_net.hpp"

namespace pliant::simulated {

namespace {

constexpr int kRounds = 8;              ///< of evening out
constexpr double kDifference = 0.0002;  ///< metres; step of the numeric gradient

Vector3 gradient_at(Solid solid, const Vector3& p) {
  Vector3 gradient;
  for (int k = 0; k < 3; ++k) {
    const Vector3 step = kDifference * Vector3::Unit(k);
    gradient[k] = (solid(p + step) - solid(p - step)) / (2 * kDifference);
  }
  return gradient;
}

Vector3 projected(Solid solid, Vector3 p) {
  for (int i = 0; i < 2; ++i) {
    const Vector3 gradient = gradient_at(solid, p);
    const double squared = gradient.squaredNorm();
    if (squared < 1e-6) break;
    p -= gradient * (solid(p) / squared);
  }
  return p;
}

/// Moves every vertex half-way to the mean of its neighbours and back onto the surface.
void even_out(Solid solid, const std::vector<std::array<std::uint32_t, 3>>& triangles,
              std::vector<Vector3>& vertices) {
  std::vector<Vector3> sum(vertices.size());
  std::vector<int> count(vertices.size());
  for (int round = 0; round < kRounds; ++round) {
    sum.assign(vertices.size(), Vector3::Zero());
    count.assign(vertices.size(), 0);
    for (const auto& t : triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        sum[t[i]] += vertices[t[(i + 1) % 3]];
        ++count[t[i]];
      }
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (count[i] > 0) vertices[i] = projected(solid, 0.5 * (vertices[i] + sum[i] / count[i]));
  }
}

}  // namespace

Geometry mesh_of(Solid solid, const Vector3& low, const Vector3& high, double spacing) {
  // A surface passes 1.5 cells per cell face of its area; even triangles of side s have 1 / (0.866 s²)
  // vertices.
  const double cell = 1.14 * spacing;
  std::array<int, 3> size{};
  for (int k = 0; k < 3; ++k)
    size[static_cast<std::size_t>(k)] = static_cast<int>((high[k] - low[k]) / cell) + 2;
  SurfaceNet net =
      surface_net(size, low, cell, [&](int x, int y, int z) { return solid(low + cell * Vector3(x, y, z)); });
  even_out(solid, net.triangles, net.vertices);
  Geometry mesh;
  mesh.triangles = std::move(net.triangles);
  for (const Vector3& p : net.vertices) {
    const Vector3 gradient = gradient_at(solid, p);
    const Vector3 n = gradient / std::sqrt(std::max(gradient.squaredNorm(), 1e-12));
    mesh.vertices.push_back(to_point(p));
    mesh.normals.push_back(to_point(n));
  }
  return mesh;
}

}  // namespace pliant::simulated

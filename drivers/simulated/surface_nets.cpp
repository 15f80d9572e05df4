#include "drivers/simulated/surface_nets.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pliant::simulated {

namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr int kRounds = 8;              ///< of evening out
constexpr double kDifference = 0.0002;  ///< metres; step of the numeric gradient

/// The grid of samples and what grows on it. Everything has one fixed order.
class Grid {
 public:
  Grid(Solid solid, const Vector3& low, const Vector3& high, double cell) : low_(low), cell_(cell) {
    for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>((high[k] - low[k]) / cell) + 2;
    samples_.reserve(index(size_[0] - 1, size_[1] - 1, size_[2] - 1) + 1);
    for (int z = 0; z < size_[2]; ++z)
      for (int y = 0; y < size_[1]; ++y)
        for (int x = 0; x < size_[0]; ++x) samples_.push_back(solid(node(x, y, z)));
    vertex_of_cell_.assign(samples_.size(), kNone);
  }

  /// One vertex in every cell that the surface passes: the mean of its crossings with the cell's edges.
  void place_vertices(std::vector<Vector3>& vertices) {
    for (int z = 0; z + 1 < size_[2]; ++z)
      for (int y = 0; y + 1 < size_[1]; ++y)
        for (int x = 0; x + 1 < size_[0]; ++x) {
          Vector3 sum = Vector3::Zero();
          int crossings = 0;
          for (int axis = 0; axis < 3; ++axis)
            for (int corner = 0; corner < 4; ++corner) {
              std::array<int, 3> a{x, y, z};
              a[static_cast<std::size_t>((axis + 1) % 3)] += corner & 1;
              a[static_cast<std::size_t>((axis + 2) % 3)] += corner >> 1;
              std::array<int, 3> b = a;
              ++b[static_cast<std::size_t>(axis)];
              const double fa = sample(a);
              const double fb = sample(b);
              if ((fa < 0) == (fb < 0)) continue;
              const Vector3 pa = node(a[0], a[1], a[2]);
              const Vector3 pb = node(b[0], b[1], b[2]);
              sum += pa + (pb - pa) * (fa / (fa - fb));
              ++crossings;
            }
          if (crossings == 0) continue;
          vertex_of_cell_[index(x, y, z)] = static_cast<std::uint32_t>(vertices.size());
          vertices.push_back(sum / crossings);
        }
  }

  /// Two triangles across every grid edge that the surface cuts, joined along the shorter diagonal.
  void place_triangles(const std::vector<Vector3>& vertices,
                       std::vector<std::array<std::uint32_t, 3>>& triangles) const {
    for (int z = 1; z + 1 < size_[2]; ++z)
      for (int y = 1; y + 1 < size_[1]; ++y)
        for (int x = 1; x + 1 < size_[0]; ++x)
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::array<int, 3> a{x, y, z};
            std::array<int, 3> b = a;
            ++b[axis];
            const bool inside = sample(a) < 0;
            if (inside == (sample(b) < 0)) continue;
            std::array<std::uint32_t, 4> ring{};
            for (std::size_t i = 0; i < 4; ++i) {
              std::array<int, 3> c = a;
              if (i == 0 || i == 3) --c[(axis + 1) % 3];
              if (i < 2) --c[(axis + 2) % 3];
              ring[i] = vertex_of_cell_[index(c[0], c[1], c[2])];
            }
            if (!inside) std::swap(ring[1], ring[3]);
            const double d02 = (vertices[ring[0]] - vertices[ring[2]]).squaredNorm();
            const double d13 = (vertices[ring[1]] - vertices[ring[3]]).squaredNorm();
            const std::size_t first = d02 <= d13 ? 0 : 1;
            triangles.push_back({ring[first], ring[first + 1], ring[first + 2]});
            triangles.push_back({ring[first], ring[first + 2], ring[(first + 3) % 4]});
          }
  }

 private:
  [[nodiscard]] Vector3 node(int x, int y, int z) const { return low_ + cell_ * Vector3(x, y, z); }
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    const auto width = static_cast<std::size_t>(size_[0]);
    const auto height = static_cast<std::size_t>(size_[1]);
    return (static_cast<std::size_t>(z) * height + static_cast<std::size_t>(y)) * width +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] double sample(const std::array<int, 3>& n) const { return samples_[index(n[0], n[1], n[2])]; }

  Vector3 low_;
  double cell_;
  Eigen::Vector3i size_;
  std::vector<double> samples_;
  std::vector<std::uint32_t> vertex_of_cell_;
};

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
  std::vector<Vector3> vertices;
  Geometry mesh;
  // A surface passes 1.5 cells per cell face of its area; even triangles of side s have 1 / (0.866 s²)
  // vertices.
  Grid grid(solid, low, high, 1.14 * spacing);
  grid.place_vertices(vertices);
  grid.place_triangles(vertices, mesh.triangles);
  even_out(solid, mesh.triangles, vertices);
  for (const Vector3& p : vertices) {
    const Vector3 gradient = gradient_at(solid, p);
    const Vector3 n = gradient / std::sqrt(std::max(gradient.squaredNorm(), 1e-12));
    mesh.vertices.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    mesh.normals.push_back({static_cast<float>(n.x()), static_cast<float>(n.y()), static_cast<float>(n.z())});
  }
  return mesh;
}

}  // namespace pliant::simulated

// The surface at which a function on a grid changes its sign, as triangles.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

struct SurfaceNet {
  std::vector<Vector3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the positive side
};

/// Dual contouring of a grid without hermite data (Gibson: Constrained elastic surface nets, 1998).
///
/// `sample(x, y, z)`: the function at a node, negative inside, not-a-number where it is not known: cells with
/// such a corner hold no surface, which leaves a border there. Asked once a node and layer. Memory: two
/// layers and the result. `size`: nodes along x, y, z; node n lies at low + cell · n.
template <typename Sample>
[[nodiscard]] SurfaceNet surface_net(const std::array<int, 3>& size, const Vector3& low, double cell,
                                     Sample&& sample) {
  constexpr std::uint32_t kNone = 0xffffffff;
  const auto width = static_cast<std::size_t>(size[0]);
  const std::size_t layer = width * static_cast<std::size_t>(size[1]);
  // Samples of the layers z and z + 1, vertices of the cells of the layers z - 1 and z.
  std::vector<double> here(layer), above(layer);
  std::vector<std::uint32_t> cells_below(layer, kNone), cells(layer, kNone);
  const auto in_layer = [width](int x, int y) {
    return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
  };
  const auto fill = [&](std::vector<double>& samples, int z) {
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) samples[in_layer(x, y)] = sample(x, y, z);
  };
  // All corners of a cell are known, and not all on one side.
  const auto passes = [](const std::array<double, 4>& lower, const std::array<double, 4>& upper) {
    bool inside = false, outside = false;
    for (std::size_t i = 0; i < 4; ++i)
      for (const double value : {lower[i], upper[i]}) {
        if (std::isnan(value)) return false;
        (value < 0 ? inside : outside) = true;
      }
    return inside && outside;
  };
  const auto node = [&](int x, int y, int z) -> Vector3 { return low + cell * Vector3(x, y, z); };
  SurfaceNet net;

  // One vertex in every cell that the surface passes: the mean of its crossings with the cell's edges.
  const auto place_vertices = [&](int z) {
    cells.assign(layer, kNone);
    for (int y = 0; y + 1 < size[1]; ++y)
      for (int x = 0; x + 1 < size[0]; ++x) {
        const auto value = [&](const std::array<int, 3>& n) {
          return (n[2] == z ? here : above)[in_layer(n[0], n[1])];
        };
        // Most cells hold nothing.
        const std::size_t at = in_layer(x, y);
        if (!passes({here[at], here[at + 1], here[at + width], here[at + width + 1]},
                    {above[at], above[at + 1], above[at + width], above[at + width + 1]}))
          continue;
        Vector3 sum = Vector3::Zero();
        int crossings = 0;
        for (int axis = 0; axis < 3; ++axis)
          for (int corner = 0; corner < 4; ++corner) {
            std::array<int, 3> a{x, y, z};
            a[static_cast<std::size_t>((axis + 1) % 3)] += corner & 1;
            a[static_cast<std::size_t>((axis + 2) % 3)] += corner >> 1;
            std::array<int, 3> b = a;
            ++b[static_cast<std::size_t>(axis)];
            const double fa = value(a);
            const double fb = value(b);
            if ((fa < 0) == (fb < 0)) continue;
            const Vector3 pa = node(a[0], a[1], a[2]);
            const Vector3 pb = node(b[0], b[1], b[2]);
            sum += pa + (pb - pa) * (fa / (fa - fb));
            ++crossings;
          }
        cells[at] = static_cast<std::uint32_t>(net.vertices.size());
        net.vertices.push_back(sum / crossings);
      }
  };
  // Two triangles across every grid edge that the surface cuts, joined along the shorter diagonal.
  const auto place_triangles = [&](int z) {
    for (int y = 1; y + 1 < size[1]; ++y)
      for (int x = 1; x + 1 < size[0]; ++x) {
        const double from = here[in_layer(x, y)];
        if (std::isnan(from)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double to = axis == 0   ? here[in_layer(x + 1, y)]
                            : axis == 1 ? here[in_layer(x, y + 1)]
                                        : above[in_layer(x, y)];
          const bool inside = from < 0;
          if (std::isnan(to) || inside == (to < 0)) continue;
          std::array<std::uint32_t, 4> ring{};
          bool whole = true;
          for (std::size_t i = 0; i < 4; ++i) {
            std::array<int, 3> c{x, y, z};
            if (i == 0 || i == 3) --c[(axis + 1) % 3];
            if (i < 2) --c[(axis + 2) % 3];
            ring[i] = (c[2] == z ? cells : cells_below)[in_layer(c[0], c[1])];
            whole = whole && ring[i] != kNone;
          }
          if (!whole) continue;
          if (!inside) std::swap(ring[1], ring[3]);
          const double d02 = (net.vertices[ring[0]] - net.vertices[ring[2]]).squaredNorm();
          const double d13 = (net.vertices[ring[1]] - net.vertices[ring[3]]).squaredNorm();
          const std::size_t first = d02 <= d13 ? 0 : 1;
          net.triangles.push_back({ring[first], ring[first + 1], ring[first + 2]});
          net.triangles.push_back({ring[first], ring[first + 2], ring[(first + 3) % 4]});
        }
      }
  };

  fill(here, 0);
  for (int z = 0; z + 1 < size[2]; ++z) {
    fill(above, z + 1);
    place_vertices(z);
    if (z > 0) place_triangles(z);
    std::swap(here, above);
    std::swap(cells_below, cells);
  }
  return net;
}

}  // namespace pliant

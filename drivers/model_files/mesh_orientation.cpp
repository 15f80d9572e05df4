#include "drivers/model_files/mesh_orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "drivers/model_files/outside_view.hpp"

namespace pliant {

namespace {

/// An edge with one of its triangles; `forward`: the triangle runs from the lower to the higher vertex.
struct EdgeUse {
  std::uint32_t low, high, triangle;
  bool forward;
};

std::vector<EdgeUse> sorted_edges(const Mesh& mesh) {
  std::vector<EdgeUse> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
  });
  return edges;
}

struct Neighbour {
  std::uint32_t triangle;
  bool same_winding;
};

/// Triangles that share an edge which belongs to just the two of them.
struct Adjacency {
  std::vector<std::vector<Neighbour>> of;
  std::vector<bool> on_border;  // has an edge of its own alone
  bool closed = true;
};

Adjacency find_neighbours(const Mesh& mesh) {
  Adjacency adjacency{std::vector<std::vector<Neighbour>>(mesh.triangles.size()),
                      std::vector<bool>(mesh.triangles.size(), false)};
  const std::vector<EdgeUse> edges = sorted_edges(mesh);
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high)
      ++end;
    const EdgeUse& a = edges[begin];
    if (end - begin == 2) {
      const EdgeUse& b = edges[begin + 1];
      adjacency.of[a.triangle].push_back({b.triangle, a.forward != b.forward});
      adjacency.of[b.triangle].push_back({a.triangle, a.forward != b.forward});
    } else {
      for (std::size_t i = begin; i < end; ++i) adjacency.on_border[edges[i].triangle] = true;
      if ((end - begin) % 2 == 1) adjacency.closed = false;
    }
  }
  return adjacency;
}

void turn(Triangle& t) {
  std::swap(t[1], t[2]);
}

/// The connected parts of the surface.
struct Parts {
  std::vector<std::uint32_t> of;  // of each triangle
  std::uint32_t count = 0;
  double turned_area = 0;  // twice
};

/// Winds each connected part alike, as the larger area of it was wound.
Parts wind_alike(Mesh& mesh, const Adjacency& adjacency) {
  constexpr std::uint32_t none = 0xFFFFFFFFU;
  Parts parts{std::vector<std::uint32_t>(mesh.triangles.size(), none)};
  std::vector<std::uint32_t> members;
  std::vector<bool> turned(mesh.triangles.size(), false);
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (parts.of[seed] != none) continue;
    members.assign(1, seed);
    parts.of[seed] = parts.count;
    double kept_area = 0, turned_area = 0;
    for (std::size_t m = 0; m < members.size(); ++m) {
      const std::uint32_t t = members[m];
      (turned[t] ? turned_area : kept_area) += area_vector(mesh, mesh.triangles[t]).norm();
      for (const Neighbour& next : adjacency.of[t]) {
        if (parts.of[next.triangle] != none) continue;
        parts.of[next.triangle] = parts.count;
        turned[next.triangle] = turned[t] == next.same_winding;
        members.push_back(next.triangle);
      }
    }
    const bool other_way = turned_area > kept_area;
    for (const std::uint32_t t : members)
      if (turned[t] != other_way) turn(mesh.triangles[t]);
    parts.turned_area += std::min(kept_area, turned_area);
    ++parts.count;
  }
  return parts;
}

/// What speaks for and against a part's winding.
struct Evidence {
  double volume = 0;  // six times
  double extent = 0;  // sum of the same terms' magnitudes: tells a volume from rounding
  bool closed = true;
  SideVotes seen;
  double given = 0;  // agreement with the normals of the file, by area
};

bool should_turn(const Evidence& e) {
  if (e.closed && std::fabs(e.volume) > 1e-6 * e.extent) return e.volume < 0;
  // Two to one: a flat or hardly seen part does not decide.
  constexpr double kEnoughPixels = 20;
  if (e.seen.front + e.seen.back > kEnoughPixels) {
    if (e.seen.back > 2 * e.seen.front) return true;
    if (e.seen.front > 2 * e.seen.back) return false;
  }
  return e.given < 0;
}

}  // namespace

bool orient_mesh(Mesh& mesh, std::vector<std::string>& warnings) {
  const Adjacency adjacency = find_neighbours(mesh);
  Parts parts = wind_alike(mesh, adjacency);
  const std::vector<SideVotes> votes = see_triangles(mesh);
  std::vector<Evidence> evidence(parts.count);
  Vector3 middle = Vector3::Zero();
  for (const Vector3& v : mesh.vertices) middle += v / static_cast<double>(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Evidence& e = evidence[parts.of[i]];
    const Triangle& t = mesh.triangles[i];
    const Vector3 area = area_vector(mesh, t);
    const double volume = area.dot(mesh.vertices[t[0]] - middle);
    e.volume += volume;
    e.extent += std::fabs(volume);
    e.closed = e.closed && !adjacency.on_border[i];
    e.seen.front += votes[i].front;
    e.seen.back += votes[i].back;
    if (!mesh.given_normals.empty())
      for (const std::uint32_t corner : t) e.given += area.dot(mesh.given_normals[corner]);
  }
  double all_area = 0, turned_area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const double area = area_vector(mesh, mesh.triangles[i]).norm();
    all_area += area;
    if (!should_turn(evidence[parts.of[i]])) continue;
    turn(mesh.triangles[i]);
    turned_area += area;
  }
  constexpr double kWorthSaying = 0.01;  // of the surface; slivers where it is not sound are common
  if (parts.turned_area > kWorthSaying * all_area)
    warnings.push_back(
        fmt::format("{:.0f} % of the surface is wound against its neighbours and is turned over",
                    100 * parts.turned_area / all_area));
  if (turned_area > kWorthSaying * all_area)
    warnings.push_back(
        fmt::format("{:.0f} % of the surface faces inward and is turned over", 100 * turned_area / all_area));
  return adjacency.closed;
}

bool is_closed(const Mesh& mesh) {
  return find_neighbours(mesh).closed;
}

}  // namespace pliant

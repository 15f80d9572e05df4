#include "drivers/model_files/mesh_smoothing.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace pliant {

namespace {

/// Taubin's factors: the filter passes wavelengths above some ten edges unchanged (pass band 0.1).
constexpr double kShrink = 0.5, kGrow = -0.526;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Every edge once, the lower vertex first; and which vertices lie on one that has not two triangles.
std::vector<Edge> edges_of(const Mesh& mesh, std::vector<bool>& on_border) {
  std::vector<Edge> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) uses.push_back(std::minmax({t[k], t[(k + 1) % 3]}));
  std::sort(uses.begin(), uses.end());
  std::vector<Edge> edges;
  on_border.assign(mesh.vertices.size(), false);
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    while (end < uses.size() && uses[end] == uses[i]) ++end;
    if (end - i != 2) on_border[uses[i].first] = on_border[uses[i].second] = true;
    edges.push_back(uses[i]);
    i = end;
  }
  return edges;
}

}  // namespace

void smooth_grain(Mesh& mesh, int rounds) {
  std::vector<bool> on_border;
  const std::vector<Edge> edges = edges_of(mesh, on_border);
  std::vector<Vector3> sum(mesh.vertices.size());
  std::vector<double> count(mesh.vertices.size(), 0);
  for (const auto& [a, b] : edges) {
    ++count[a];
    ++count[b];
  }
  for (int step = 0; step < 2 * rounds; ++step) {
    std::fill(sum.begin(), sum.end(), Vector3::Zero());
    for (const auto& [a, b] : edges) {
      sum[a] += mesh.vertices[b];
      sum[b] += mesh.vertices[a];
    }
    const double factor = step % 2 == 0 ? kShrink : kGrow;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      if (!on_border[i] && count[i] > 0) mesh.vertices[i] += factor * (sum[i] / count[i] - mesh.vertices[i]);
  }
}

}  // namespace pliant

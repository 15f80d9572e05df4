#include "drivers/model_files/neighbour_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/model/model_view.hpp"
#include "drivers/model_files/nearest.hpp"

namespace pliant {

namespace {

constexpr std::size_t kLookedAt = 48;      // nearest in space
constexpr double kLeastAgreement = -0.25;  // cosine of the normals
constexpr double kStacked = 0.8;    // sine of the rise from one point to the other, above it they are stacked
constexpr double kGapSpacings = 4;  // farther points are neighbours only where the sampling is as sparse

bool on_same_sheet(const OrientedCloud& cloud, std::size_t a, std::size_t b, double distance) {
  const double agreement = cloud.normals[a].dot(cloud.normals[b]);
  if (agreement < kLeastAgreement) return false;
  if (agreement < 0.5)
    return true;  // an edge or a tight bend: either point may lie high above the other's plane
  const Vector3 step = cloud.points[b] - cloud.points[a];
  return std::fabs(cloud.normals[a].dot(step)) <= kStacked * distance;
}

}  // namespace

std::vector<std::uint16_t> neighbour_graph(const OrientedCloud& cloud, double spacing) {
  const NearestPoints tree(cloud.points);
  std::vector<std::uint16_t> graph(cloud.points.size() * limits::kNeighbours, kNoNeighbour);
  std::array<std::uint32_t, kLookedAt> nearest{};
  std::array<double, kLookedAt> squares{};
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::size_t count = tree.nearest(cloud.points[i], nearest, squares);
    std::size_t taken = 0;
    double farthest = kGapSpacings * spacing;
    for (std::size_t k = 0; k < count && taken < limits::kNeighbours; ++k) {
      const double distance = std::sqrt(squares[k]);
      if (nearest[k] == i || !on_same_sheet(cloud, i, nearest[k], distance)) continue;
      if (taken == 0) farthest = std::max(farthest, 2.5 * distance);
      if (distance > farthest) break;
      graph[i * limits::kNeighbours + taken++] = static_cast<std::uint16_t>(nearest[k]);
    }
  }
  return graph;
}

}  // namespace pliant

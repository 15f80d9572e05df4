#include "drivers/model_files/neighbour_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

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

/// Which eighth of a turn around its normal a step goes to.
class Sectors {
 public:
  explicit Sectors(const Vector3& normal) {
    const Vector3 helper = std::fabs(normal.x()) < 0.6 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
    first_ = unit_or_zero(cross(normal, helper));
    second_ = cross(normal, first_);
  }
  [[nodiscard]] std::size_t of(const Vector3& step) const {
    const double x = first_.dot(step), y = second_.dot(step);
    return (x < 0 ? 4U : 0U) + (y < 0 ? 2U : 0U) + (std::fabs(x) < std::fabs(y) ? 1U : 0U);
  }

 private:
  Vector3 first_, second_;
};

struct Candidate {
  std::uint32_t index;
  double distance;
};

/// Chooses from `candidates` (nearest first) the nearest of each eighth of a turn, so that a surface that is
/// sampled along lines hangs together across them too; then the nearest others until there are enough.
/// Returns how many; they stand first, nearest first.
std::size_t choose(const OrientedCloud& cloud, std::size_t centre, std::span<Candidate> candidates) {
  const Sectors sectors(cloud.normals[centre]);
  std::array<bool, limits::kNeighbours> filled{};
  const auto others = std::stable_partition(candidates.begin(), candidates.end(), [&](const Candidate& c) {
    const std::size_t sector = sectors.of(cloud.points[c.index] - cloud.points[centre]);
    const bool first = !filled[sector];
    filled[sector] = true;
    return first;
  });
  const std::size_t wanted = std::min(candidates.size(), limits::kNeighbours);
  if (others - candidates.begin() < static_cast<std::ptrdiff_t>(wanted))
    std::inplace_merge(candidates.begin(), others, candidates.begin() + static_cast<std::ptrdiff_t>(wanted),
                       [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  return wanted;
}

}  // namespace

std::vector<std::uint16_t> neighbour_graph(const OrientedCloud& cloud, double spacing) {
  static_assert(limits::kNeighbours == 8, "one neighbour for each eighth of a turn");
  const NearestPoints tree(cloud.points);
  std::vector<std::uint16_t> graph(cloud.points.size() * limits::kNeighbours, kNoNeighbour);
  std::array<std::uint32_t, kLookedAt> nearest{};
  std::array<double, kLookedAt> squares{};
  std::array<Candidate, kLookedAt> candidates{};
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::size_t count = tree.nearest(cloud.points[i], nearest, squares);
    std::size_t found = 0;
    double farthest = kGapSpacings * spacing;
    for (std::size_t k = 0; k < count; ++k) {
      const double distance = std::sqrt(squares[k]);
      if (nearest[k] == i || !on_same_sheet(cloud, i, nearest[k], distance)) continue;
      if (found == 0) farthest = std::max(farthest, 2.5 * distance);
      if (distance > farthest) break;
      candidates[found++] = {nearest[k], distance};
    }
    const std::size_t chosen = choose(cloud, i, std::span(candidates).first(found));
    for (std::size_t k = 0; k < chosen; ++k)
      graph[i * limits::kNeighbours + k] = static_cast<std::uint16_t>(candidates[k].index);
  }
  return graph;
}

}  // namespace pliant

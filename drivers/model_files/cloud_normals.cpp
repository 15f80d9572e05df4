#include "drivers/model_files/cloud_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <queue>

#include "core/detect/symmetric_eigen.hpp"
#include "drivers/model_files/nearest.hpp"
#include "drivers/model_files/outside_view.hpp"

namespace pliant {

namespace {

constexpr std::size_t kAround = 16;
constexpr std::size_t kAroundLines = 64;  // where the nearest lie in a line or a heap and tell no plane
constexpr double kLineShare = 0.1;        // spread across a line, as a share of that along it

/// kAround + 1 nearest of each point, itself among them.
class Surroundings {
 public:
  explicit Surroundings(std::span<const Vector3> points)
      : indices_(points.size() * (kAround + 1)), squares_(indices_.size()) {
    const NearestPoints tree(points);
    counts_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      counts_.push_back(tree.nearest(points[i], std::span(indices_).subspan(i * (kAround + 1), kAround + 1),
                                     std::span(squares_).subspan(i * (kAround + 1), kAround + 1)));
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t i) const {
    return std::span(indices_).subspan(i * (kAround + 1), counts_[i]);
  }

 private:
  std::vector<std::uint32_t> indices_;
  std::vector<double> squares_;
  std::vector<std::size_t> counts_;
};

/// How `around` spreads, axes in ascending order; all zero where it does not.
SymmetricEigen spread_of(std::span<const Vector3> points, std::span<const std::uint32_t> around) {
  Vector3 mean = Vector3::Zero();
  for (const std::uint32_t i : around) mean += points[i];
  mean /= static_cast<double>(around.size());
  Matrix3 spread = Matrix3::Zero();
  for (const std::uint32_t i : around) {
    const Vector3 d = points[i] - mean;
    spread += d * d.transpose();
  }
  return symmetric_eigen(spread / std::max(spread.trace(), 1e-300));
}

/// Closer heaps than this, in spacings, are noise rather than surface.
constexpr double kHeap = 1.2;

std::vector<Vector3> directions_of_least_spread(std::span<const Vector3> points, double spacing,
                                                const Surroundings& around) {
  const NearestPoints tree(points);
  std::array<std::uint32_t, kAroundLines> more{};
  std::array<double, kAroundLines> squares{};
  std::vector<Vector3> normals(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    SymmetricEigen spread = spread_of(points, around.of(i));
    const double reach = (points[around.of(i).back()] - points[i]).norm();
    if (reach < kHeap * spacing || spread.values(1) < kLineShare * spread.values(2))
      spread = spread_of(points, std::span(more).first(tree.nearest(points[i], more, squares)));
    const Vector3 normal = unit_or_zero(spread.vectors.col(0));
    normals[i] = normal.isZero() ? Vector3(0, 0, 1) : normal;
  }
  return normals;
}

/// One step of the spanning tree: from a point whose sign is known to one whose sign is not.
struct Step {
  double turn;  // 1 - |cosine|
  std::uint32_t from, to;
  [[nodiscard]] bool operator<(const Step& other) const {  // the smallest turn first, then the lowest index
    if (turn != other.turn) return turn > other.turn;
    return to != other.to ? to > other.to : from > other.from;
  }
};

/// Gives all normals of `seed`'s connected part the seed's sign. Appends the part to `members`.
void spread_sign(const Surroundings& around, std::uint32_t seed, std::vector<Vector3>& normals,
                 std::vector<bool>& known, std::vector<std::uint32_t>& members) {
  std::priority_queue<Step> steps;
  const auto take = [&](std::uint32_t i) {
    known[i] = true;
    members.push_back(i);
    for (const std::uint32_t j : around.of(i))
      if (!known[j]) steps.push({1 - std::fabs(normals[i].dot(normals[j])), i, j});
  };
  take(seed);
  while (!steps.empty()) {
    const Step step = steps.top();
    steps.pop();
    if (known[step.to]) continue;
    if (normals[step.from].dot(normals[step.to]) < 0) normals[step.to] = -normals[step.to];
    take(step.to);
  }
}

}  // namespace

std::vector<Vector3> estimate_normals(std::span<const Vector3> points, double spacing) {
  const Surroundings around(points);
  std::vector<Vector3> normals = directions_of_least_spread(points, spacing, around);

  std::vector<bool> known(points.size(), false);
  std::vector<std::vector<std::uint32_t>> parts;
  for (std::uint32_t seed = 0; seed < points.size(); ++seed)
    if (!known[seed]) spread_sign(around, seed, normals, known, parts.emplace_back());

  const OrientedCloud cloud{{points.begin(), points.end()}, normals};
  const std::vector<SideVotes> votes = see_points(cloud, spacing);
  for (const std::vector<std::uint32_t>& part : parts) {
    double front = 0, back = 0;
    for (const std::uint32_t i : part) {
      front += votes[i].front;
      back += votes[i].back;
    }
    if (back > front)
      for (const std::uint32_t i : part) normals[i] = -normals[i];
  }
  return normals;
}

std::vector<Vector3> complete_normals(std::span<const Vector3> points, std::span<const Vector3> given,
                                      double spacing, std::vector<std::string>& warnings) {
  OrientedCloud cloud{{points.begin(), points.end()}, {given.begin(), given.end()}};
  if (std::any_of(given.begin(), given.end(), [](const Vector3& n) { return n.isZero(); })) {
    const std::vector<Vector3> estimated = estimate_normals(points, spacing);
    std::vector<Vector3> known_points, known_normals;
    for (std::size_t i = 0; i < given.size(); ++i)
      if (!given[i].isZero()) {
        known_points.push_back(points[i]);
        known_normals.push_back(given[i]);
      }
    if (known_points.empty()) return estimated;
    const NearestPoints tree(known_points);
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (!given[i].isZero()) continue;
      double square = 0;
      const Vector3& like = known_normals[tree.nearest(points[i], square)];
      cloud.normals[i] = estimated[i].dot(like) < 0 ? Vector3(-estimated[i]) : estimated[i];
    }
  }
  double front = 0, back = 0;
  for (const SideVotes& votes : see_points(cloud, spacing)) {
    front += votes.front;
    back += votes.back;
  }
  if (back > 2 * front) {
    for (Vector3& normal : cloud.normals) normal = -normal;
    warnings.push_back("the normals of the file face inward and are turned over");
  }
  return cloud.normals;
}

}  // namespace pliant

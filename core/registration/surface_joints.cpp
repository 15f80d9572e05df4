#include "core/registration/surface_joints.hpp"

#include <algorithm>
#include <cmath>

#include "core/registration/chain_measures.hpp"

namespace pliant {

namespace {

constexpr float kNowhere = 1e9F;
constexpr int kSweeps = 48;
constexpr double kStrain = 0.15;       // that soft matter takes across a joint
constexpr double kJoint = 0.1;         // of the model's radius: as deep as a joint reaches into a part
constexpr double kLargestTear = 0.01;  // metres: what no joint may come apart by

}  // namespace

void measure_reach(RegistrationState& s, std::span<const std::int8_t> labels) noexcept {
  const std::size_t n = s.model.size();
  for (std::size_t i = 0; i < n; ++i) {
    s.along[i] = labels[i] >= 0 ? 0 : kNowhere;
    s.anchor[i] = static_cast<std::uint16_t>(i);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool changed = false;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = sweep % 2 == 0 ? k : n - 1 - k;
      const Point3f& p = s.model.positions()[i];
      for (const std::uint16_t j : s.model.neighbours(i)) {
        if (j == kNoNeighbour || s.along[j] >= s.along[i]) continue;
        const Point3f& q = s.model.positions()[j];
        const float way = s.along[j] + std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) +
                                                 (p.z - q.z) * (p.z - q.z));
        if (way >= s.along[i]) continue;
        s.along[i] = way;
        s.anchor[i] = s.anchor[j];
        changed = true;
      }
    }
    if (!changed) break;
  }
}

bool within_reach(const RegistrationState& s, std::span<const std::int8_t> labels,
                  std::span<const RigidTransform> poses, std::size_t i, const Vector3& scene) noexcept {
  if (s.along[i] >= kNowhere) return true;
  const std::size_t anchor = s.anchor[i];
  const Vector3 at = poses[static_cast<std::size_t>(labels[anchor])] * to_vector(s.model.positions()[anchor]);
  const double most =
      (1 + kStrain) * static_cast<double>(s.along[i]) + std::min(match_tolerance(s), kLargestTear);
  return (scene - at).squaredNorm() <= most * most;
}

double joint_gap(const RegistrationState& s, std::span<const std::int8_t> labels,
                 std::span<const RigidTransform> poses, std::uint32_t piece,
                 const RigidTransform& pose) noexcept {
  float nearest = kNowhere;
  for (std::size_t i = 0; i < s.model.size(); ++i)
    if (s.islands.piece()[i] == piece && s.along[i] > 0) nearest = std::min(nearest, s.along[i]);
  if (nearest >= kNowhere) return 0;
  // The joint is somewhere between: where a limb turns about it, the axis runs through the limb, and what
  // lies on it both transforms take to one place, while the rest of the ring stretches. What is torn off is
  // apart everywhere.
  const float ring = nearest + static_cast<float>(kJoint * s.model.radius());
  double least = 1e9;
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    if (s.along[i] <= 0 || s.along[i] > ring) continue;
    const std::size_t anchor = s.anchor[i];
    const RigidTransform& region = poses[static_cast<std::size_t>(labels[anchor])];
    for (const std::size_t k : {i, anchor}) {
      const Vector3 x = to_vector(s.model.positions()[k]);
      least = std::min(least, (pose * x - region * x).norm() - kStrain * static_cast<double>(s.along[i]));
    }
  }
  return std::max(0.0, least);
}

double largest_joint_gap(const RegistrationState& s) noexcept {
  return std::min(kLargestTear, 0.02 * s.model.radius() + s.spacing);
}

}  // namespace pliant

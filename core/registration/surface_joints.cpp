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
constexpr double kDeep = 0.05;         // of the model's radius: kLargestTear of an object 40 cm across
constexpr double kSampling = 0.25;     // of the spacing: what sampling leaves of a place
constexpr double kLargestTear = 0.01;  // metres: what no joint may come apart by
// Where a part moved, the surface that a region expects there and the one that is seen cross. Along the line
// the region explains a strip by chance: at 20° it reaches 2.7 spacings to each side, as what is off by a
// spacing counts as explained.
constexpr std::uint32_t kStripRings = 3;
constexpr std::uint32_t kSolid = 100;

/// s.proposal: kSolid and more where what a region explains is no strip: more than kStripRings deep, or as
/// near to what is (an opening, in the terms of morphology).
void find_solid(RegistrationState& s, std::span<const std::int8_t> labels) noexcept {
  const std::size_t n = s.model.size();
  for (std::size_t i = 0; i < n; ++i) s.proposal[i] = labels[i] >= 0 ? kSolid : 0;
  // Rings count from outside in, then what is left grows back.
  for (std::uint32_t ring = 1; ring <= kStripRings; ++ring)
    for (std::size_t i = 0; i < n; ++i) {
      if (s.proposal[i] != kSolid) continue;
      for (const std::uint16_t j : s.model.neighbours(i))
        if (j != kNoNeighbour && s.proposal[j] == ring - 1) s.proposal[i] = ring;
    }
  for (std::uint32_t ring = 1; ring <= kStripRings; ++ring)
    for (std::size_t i = 0; i < n; ++i) {
      if (s.proposal[i] == 0 || s.proposal[i] >= kSolid) continue;
      for (const std::uint16_t j : s.model.neighbours(i))
        if (j != kNoNeighbour && s.proposal[j] == kSolid + ring - 1) s.proposal[i] = kSolid + ring;
    }
}

}  // namespace

void measure_reach(RegistrationState& s, std::span<const std::int8_t> labels) noexcept {
  const std::size_t n = s.model.size();
  find_solid(s, labels);
  for (std::size_t i = 0; i < n; ++i) {
    s.along[i] = s.proposal[i] >= kSolid ? 0 : kNowhere;
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
  // The outer side of a joint that turns by a radian grows by as much as the joint is thick.
  const double most = (1 + kStrain) * static_cast<double>(s.along[i]) + kJoint * s.model.radius() +
                      std::min(match_tolerance(s), kLargestTear);
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
  // Matter of a joint's length that bends evenly by an angle has its ends elsewhere than a hinge would put
  // them, by a twelfth of the length times the angle's square.
  const double length = kJoint * s.model.radius(), most = kLargestTear - largest_joint_gap(s);
  // The piece's own points begin beyond the joint, which is the larger the larger the object.
  const double deep =
      std::max(kLargestTear, kDeep * s.model.radius()) + kSampling * s.spacing - largest_joint_gap(s);
  double least = 1e9, own = 1e9;  // what lies between; of that, the piece's own points
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    if (s.along[i] <= 0 || s.along[i] > ring) continue;
    const std::size_t anchor = s.anchor[i];
    const RigidTransform& region = poses[static_cast<std::size_t>(labels[anchor])];
    const double square_angle = 2 - 2 * cos_angle(region.rotation.transpose() * pose.rotation);
    const double give =
        std::min(most, kStrain * static_cast<double>(s.along[i]) + length * square_angle / 12);
    for (const std::size_t k : {i, anchor}) {
      const Vector3 x = to_vector(s.model.positions()[k]);
      const double gap = (pose * x - region * x).norm();
      least = std::min(least, gap - give);
      if (s.islands.piece()[k] == piece) own = std::min(own, gap - deep);
    }
  }
  return std::max({0.0, least, own});
}

double largest_joint_gap(const RegistrationState& s) noexcept {
  return std::min(kLargestTear, 0.02 * s.model.radius() + s.spacing);
}

}  // namespace pliant

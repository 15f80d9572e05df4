#include "core/registration/limb_trial.hpp"

#include <algorithm>

namespace pliant {

namespace {

constexpr std::size_t kFewSamples = 100;  // for what many poses are asked
constexpr int kAlignSteps = 5;
constexpr int kBendRounds = 8;
constexpr double kSoft = 0.3;  // of the stiffness: a joint bends far within few edges

/// Calls visit(border, from, to) for the borders between settled patches and the limb.
template <typename Visit>
void each_joint_border(const WarpRoom& room, const PatchSet& limb, Visit&& visit) noexcept {
  for (std::size_t k = 0; k < room.patches.border_count; ++k) {
    const PatchBorder& border = room.patches.borders[k];
    if (limb.has(border.a) == limb.has(border.b)) continue;
    const std::size_t from = limb.has(border.a) ? border.b : border.a;
    if (room.settled[from]) visit(border, from, limb.has(border.a) ? border.a : border.b);
  }
}

}  // namespace

LimbJoint joint_of(const WarpRoom& room, const PatchSet& limb) noexcept {
  LimbJoint joint;
  each_joint_border(room, limb,
                    [&](const PatchBorder& border, std::size_t from, std::size_t /*to*/) noexcept {
                      joint.model += border.centre;
                      joint.scene += room.pose[from] * border.centre;
                      ++joint.borders;
                    });
  if (joint.borders == 0) return joint;
  joint.model /= static_cast<double>(joint.borders);
  joint.scene /= static_cast<double>(joint.borders);
  double nearest = 1e9;
  each_joint_border(room, limb,
                    [&](const PatchBorder& border, std::size_t from, std::size_t /*to*/) noexcept {
                      const double square = (border.centre - joint.model).squaredNorm();
                      if (square >= nearest) return;
                      nearest = square;
                      joint.root = from;
                    });
  return joint;
}

LimbTrial::LimbTrial(WarpSamples& samples, const WarpStiffness& stiffness, const PatchSet& limb,
                     const LimbJoint& joint) noexcept
    : samples_(samples), stiffness_(stiffness), limb_(limb), joint_(joint) {
  for (std::size_t k = 0; k < samples.count() && count_ < kMostSamples; ++k)
    if (limb.has(samples.patch_of(k))) own_[count_++] = static_cast<std::uint16_t>(k);
}

std::span<const std::uint16_t> LimbTrial::few() const noexcept {
  return std::span(own_).first(std::min(count_, kFewSamples));
}

std::uint32_t LimbTrial::target_of(const WarpSamples::Placed& sample, double gate, float least_alike,
                                   float& square) const noexcept {
  return samples_.target_of(sample, gate, least_alike, 0, square,
                            [&](std::uint8_t owner) noexcept { return limb_.has(owner); });
}

LimbEvidence LimbTrial::evidence() const noexcept {
  LimbEvidence found;
  for (const std::uint16_t k : std::span(own_).first(count_)) {
    const WarpSamples::Placed sample =
        samples_.placed(k, FastTransform(samples_.room().pose[samples_.patch_of(k)]));
    float square = 0;
    const std::uint32_t target = target_of(sample, 1.5 * samples_.reach(), WarpSamples::kMuchAlike, square);
    found.samples += target != PointGrid::kNone && samples_.shows(sample, target) ? 1 : 0;
  }
  found.share = found.samples / static_cast<double>(std::max<std::size_t>(1, count_));
  return found;
}

double LimbTrial::nearness(const RigidTransform& pose, double tolerance) const noexcept {
  const FastTransform fast(pose);
  double sum = 0;
  for (const std::uint16_t k : few()) {
    float square = 0;
    if (target_of(samples_.placed(k, fast), tolerance, WarpSamples::kAlike, square) != PointGrid::kNone)
      sum += 1 - static_cast<double>(square) / (tolerance * tolerance);
  }
  return sum / static_cast<double>(std::max<std::size_t>(1, few().size()));
}

bool LimbTrial::align(double gate, RigidTransform& pose) const noexcept {
  for (int step = 0; step < kAlignSteps; ++step) {
    const FastTransform fast(pose);
    const Vector3 pivot = pose * joint_.model;
    Symmetric6 a;
    Vector6 b = Vector6::Zero();
    std::size_t held = 0;
    for (const std::uint16_t k : few()) {
      const WarpSamples::Placed sample = samples_.placed(k, fast);
      float square = 0;
      const std::uint32_t target = target_of(sample, gate, WarpSamples::kAlike, square);
      if (target == PointGrid::kNone) continue;
      add_reading(samples_, sample.at, target, square, gate, pivot, a, b);
      ++held;
    }
    Factor6 factor;
    if (held < 6 || !factor.factorise(a)) return false;
    const Vector6 motion = factor.solve(b);
    if (!(motion.squaredNorm() < 1.0)) return false;  // also for not-a-number
    pose = motion_about(motion, pivot) * pose;
    pose.rotation = orthonormalised(pose.rotation);
  }
  return true;
}

void LimbTrial::bend(const RigidTransform& pose, double first, double last) noexcept {
  WarpRoom& room = samples_.room();
  limb_.for_each([&](std::size_t p) noexcept { room.pose[p] = pose; });
  for (int round = 0; round < kBendRounds; ++round) {
    const double done = std::min(1.0, 1.3 * round / (kBendRounds - 1));
    const double gate = first + (last - first) * done;
    room.system.clear(room.patches.count);
    for (std::size_t p = 0; p < room.patches.count; ++p)
      if (!limb_.has(p)) room.system.hold(p);
    for (const std::uint16_t k : std::span(own_).first(count_)) {
      const std::size_t p = samples_.patch_of(k);
      const WarpSamples::Placed sample = samples_.placed(k, FastTransform(room.pose[p]));
      float square = 0;
      const std::uint32_t target = target_of(sample, gate, WarpSamples::kAlike, square);
      if (target == PointGrid::kNone) continue;
      add_reading(samples_, sample.at, target, square, gate, room.pose[p] * room.patches.centres[p],
                  room.system.own(p), room.system.force(p));
    }
    add_springs(room, stiffness_, {.share = kSoft, .limb = &limb_});
    if (move_patches(room) < 0) return;
  }
}

double LimbTrial::tear() const noexcept {
  const WarpRoom& room = samples_.room();
  const double square = room.patches.radius * room.patches.radius;
  double sum = 0;
  each_joint_border(room, limb_, [&](const PatchBorder& border, std::size_t from, std::size_t to) noexcept {
    const Vector3 gap = room.pose[from] * border.centre - room.pose[to] * border.centre;
    sum += std::min(1.0, gap.squaredNorm() / square);
  });
  return sum / static_cast<double>(std::max<std::size_t>(1, joint_.borders));
}

}  // namespace pliant

#include "core/registration/limb_turns.hpp"

#include <algorithm>
#include <cmath>

#include "core/registration/limb_trial.hpp"

namespace pliant {

namespace {

constexpr std::size_t kFewestSamples = 25;  // of a limb: fewer fit anywhere
constexpr double kMostOfBody = 0.6;         // of the patches: more is no limb
constexpr double kTolerance = 0.12;  // of the model's radius: a limb turned by half a step of the attitudes
constexpr double kJointGives = 0.2;  // of the model's radius
constexpr double kLastGate = 3;      // of the spacing
constexpr std::size_t kRough = 40, kBent = 6;  // attitudes that are aligned, and of those, bent
constexpr double kOther = 0.98;                // cosine of the angle between different ones
// A limb is believed where the scene shows so much of it, and so much more than where it was.
constexpr double kShown = 0.4, kMore = 0.1;
constexpr double kTearCosts = 0.3;  // of a torn joint: a round ear fits in any attitude about its axis
constexpr double kSettled = 0.4;    // of a patch's samples
constexpr int kAround = 2;          // rings of patches that a piece may take along
constexpr double kStillOpen = 0.3;  // of a limb's patches, those not settled

// Tangents of half the turns, by 25° to 125°.
constexpr std::array<double, 5> kHalfTangents = {0.2217, 0.4663, 0.7673, 1.1918, 1.9210};

struct Attitude {
  double score = -1;
  RigidTransform pose;
};

/// Keeps the best, in order; of equals the first.
template <std::size_t kMost>
void offer(std::array<Attitude, kMost>& best, const Attitude& attitude) noexcept {
  std::size_t at = kMost;
  while (at > 0 && best[at - 1].score < attitude.score) --at;
  if (at == kMost) return;
  for (std::size_t k = kMost - 1; k > at; --k) best[k] = best[k - 1];
  best[at] = attitude;
}

/// The limb about its joint: as its root is turned, and turned from there about 26 axes.
std::array<Attitude, kRough> rough_attitudes(const LimbTrial& limb, const LimbJoint& joint,
                                             const Matrix3& root, double tolerance) noexcept {
  std::array<Attitude, kRough> best;
  const auto about_joint = [&](const Matrix3& rotation) noexcept {
    const RigidTransform pose = {rotation, joint.scene - rotation * joint.model};
    offer(best, {limb.nearness(pose, tolerance), pose});
  };
  about_joint(root);
  for (const double tangent : kHalfTangents)
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const double w = 1 / std::sqrt(1 + tangent * tangent);
          const double v = w * tangent / std::sqrt(static_cast<double>(x * x + y * y + z * z));
          about_joint(rotation_from_quaternion({w, v * x, v * y, v * z}) * root);
        }
  return best;
}

/// The same after rigid steps, those that stay at the joint.
std::array<Attitude, kRough> aligned_attitudes(const LimbTrial& limb, const LimbJoint& joint,
                                               const std::array<Attitude, kRough>& rough, double tolerance,
                                               double gives) noexcept {
  std::array<Attitude, kRough> best;
  for (Attitude attitude : rough) {
    if (attitude.score < 0 || !limb.align(tolerance, attitude.pose)) continue;
    if ((attitude.pose * joint.model - joint.scene).norm() > gives) continue;
    attitude.score = limb.nearness(attitude.pose, 0.7 * tolerance);
    offer(best, attitude);
  }
  return best;
}

/// Bends the best different attitudes; the best of those to room.best. What the scene shows of it.
LimbEvidence bend_best(LimbTrial& limb, WarpRoom& room, const std::array<Attitude, kRough>& attitudes,
                       double first, double last) noexcept {
  LimbEvidence winner;
  double most = -1e9;
  std::array<const Attitude*, kBent> bent{};
  std::size_t count = 0;
  room.kept = room.pose;
  for (const Attitude& attitude : attitudes) {
    if (attitude.score < 0 || count == kBent) break;
    const bool known = std::any_of(
        bent.begin(), bent.begin() + static_cast<std::ptrdiff_t>(count), [&](const Attitude* other) {
          return cos_angle(other->pose.rotation.transpose() * attitude.pose.rotation) > kOther;
        });
    if (known) continue;
    bent[count++] = &attitude;
    limb.bend(attitude.pose, first, last);
    const LimbEvidence found = limb.evidence();
    const double worth = found.share - kTearCosts * limb.tear();
    if (worth > most) {
      most = worth;
      winner = found;
      room.best = room.pose;
    }
    room.pose = room.kept;
  }
  return winner;
}

bool turn_limb(WarpSamples& samples, const WarpStiffness& stiffness, const PatchSet& limb) noexcept {
  RegistrationState& s = samples.warp().s;
  WarpRoom& room = samples.room();
  const LimbJoint joint = joint_of(room, limb);
  LimbTrial trial(samples, stiffness, limb, joint);
  if (joint.borders == 0 || trial.count() < kFewestSamples) return false;
  const double radius = s.model.radius(), tolerance = kTolerance * radius;
  const auto rough = rough_attitudes(trial, joint, room.pose[joint.root].rotation, tolerance);
  const auto near = aligned_attitudes(trial, joint, rough, tolerance, kJointGives * radius);
  const LimbEvidence before = trial.evidence();
  const LimbEvidence now = bend_best(trial, room, near, tolerance, kLastGate * s.spacing);
  s.work += work::kLimb;
  if (now.share <= kShown || now.samples <= before.samples + kMore * static_cast<double>(trial.count()))
    return false;
  room.pose = room.best;
  limb.for_each([&](std::size_t p) noexcept { room.fixed[p] = room.settled[p] = false; });
  samples.free_targets(limb);
  samples.place();
  samples.find_facing(limb);
  limb.for_each([&](std::size_t p) noexcept {
    room.settled[p] = room.asked[p] > 0 && room.close[p] >= kSettled * room.asked[p];
  });
  samples.find_owners();
  return true;
}

std::size_t size_of(const PatchSet& set) noexcept {
  std::size_t size = 0;
  set.for_each([&](std::size_t) noexcept { ++size; });
  return size;
}

PatchSet grown(const PatchTables& patches, PatchSet set, int rings) noexcept {
  for (int ring = 0; ring < rings; ++ring) {
    const PatchSet inner = set;
    inner.for_each(
        [&](std::size_t p) { patches.neighbours[p].for_each([&](std::size_t q) { set.add(q); }); });
  }
  return set;
}

/// The connected piece of wanted(patch) about `seed`.
template <typename Wanted>
PatchSet piece_of(const PatchTables& patches, std::size_t seed, Wanted&& wanted) noexcept {
  PatchSet piece;
  std::array<std::uint8_t, kMaxPatches> queue;
  std::size_t head = 0, tail = 0;
  queue[tail++] = static_cast<std::uint8_t>(seed);
  piece.add(seed);
  while (head < tail)
    patches.neighbours[queue[head++]].for_each([&](std::size_t q) {
      if (piece.has(q) || !wanted(q)) return;
      piece.add(q);
      queue[tail++] = static_cast<std::uint8_t>(q);
    });
  return piece;
}

bool turn_once(WarpSamples& samples, const WarpStiffness& stiffness, const PatchSet& limb,
               LimbMemory& memory) noexcept {
  const auto end = memory.failed.begin() + static_cast<std::ptrdiff_t>(memory.count);
  if (memory.tried == LimbMemory::kMost || std::find(memory.failed.begin(), end, limb) != end) return false;
  if (static_cast<double>(size_of(limb)) > kMostOfBody * static_cast<double>(samples.room().patches.count))
    return false;
  ++memory.tried;
  if (turn_limb(samples, stiffness, limb)) return true;
  memory.failed[memory.count++] = limb;
  return false;
}

}  // namespace

bool turn_limbs(WarpSamples& samples, const WarpStiffness& stiffness, LimbMemory& memory) noexcept {
  WarpRoom& room = samples.room();
  const PatchTables& patches = room.patches;
  const std::array<bool, kMaxPatches> settled = room.settled;
  const auto is_edge = [&](std::size_t p) noexcept {
    bool edge = false;
    patches.neighbours[p].for_each([&](std::size_t q) { edge = edge || settled[q]; });
    return edge;
  };
  bool moved = false;
  PatchSet seen;
  // First the pieces that hang together by more than their edges, which tells an ear from the arm below it.
  for (const bool inner : {true, false})
    for (std::size_t seed = 0; seed < patches.count; ++seed) {
      const auto is_open = [&](std::size_t p) noexcept {
        return !settled[p] && room.asked[p] > 0 && !seen.has(p);
      };
      const auto wanted = [&](std::size_t p) noexcept { return is_open(p) && !(inner && is_edge(p)); };
      if (!wanted(seed)) continue;
      PatchSet limb = piece_of(patches, seed, wanted);
      if (inner) {
        const PatchSet core = limb;
        grown(patches, core, 1).for_each([&](std::size_t p) {
          if (is_open(p)) limb.add(p);
        });
      }
      limb.for_each([&](std::size_t p) { seen.add(p); });
      if (turn_once(samples, stiffness, limb, memory)) {
        moved = true;
        continue;
      }
      const PatchSet wide = grown(patches, limb, kAround);
      std::size_t open = 0;
      wide.for_each([&](std::size_t p) { open += settled[p] ? 0U : 1U; });
      if (static_cast<double>(open) < kStillOpen * static_cast<double>(size_of(wide))) continue;
      moved = turn_once(samples, stiffness, wide, memory) || moved;
    }
  return moved;
}

}  // namespace pliant

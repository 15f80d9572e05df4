#include "core/track/part_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/track/freedoms.hpp"
#include "core/track/patch_flood.hpp"

namespace pliant {

namespace {

constexpr std::size_t kSeeds = 8;
/// A patch of a part is where the part's motion puts it to within this share of the inlier limit, and of what
/// the part moved by. A dent has a top that moves as one, too: where its sides fall off as a bell's do, what
/// is within a share s of the top is ln(1 - s) / ln(s) of what moved by more than that, a fifth at a quarter,
/// however deep it is; that a motion may turn as well makes it somewhat more.
constexpr double kDeviation = 0.5;
constexpr double kShareOfMotion = 0.25;
constexpr int kRounds = 4;
constexpr int kFitRounds = 3;
constexpr double kRotationSupport = 0.5;  // a patch's turn is known from its own few readings only

bool counts(const PatchWarp& warp, std::size_t p, std::int8_t k) noexcept {
  return warp.home[p] == k && patch_counts(warp, p);
}

/// What fits as well where its region is shows no motion of its own: springs drag it along with what moves.
bool shows(const PatchWarp& warp, std::size_t p, std::int8_t k) noexcept {
  return counts(warp, p, k) && !warp.fits[p];
}

struct Attempt {
  PatchSet set;
  RigidTransform pose;
  double points = 0, own = 0, region = 0;  // sums of weighted squares about the two poses
};

/// Connected patches from `seed` on that `pose` suits, and suits better than the region's pose does.
PatchSet grow(const PatchTables& patches, const PatchWarp& warp, std::int8_t k, std::size_t seed,
              const RigidTransform& pose, const RigidTransform& region, double most) noexcept {
  PatchSet set;
  set.add(seed);
  return flood(patches, set, [&](std::size_t, std::size_t q) {
    if (!counts(warp, q, k)) return false;
    const double own = patch_deviation(patches, warp, q, pose);
    return own <= most * most && own < patch_deviation(patches, warp, q, region);
  });
}

void measure(const PatchTables& patches, const PatchWarp& warp, std::int8_t k, const RigidTransform& region,
             Attempt& attempt) noexcept {
  attempt.points = attempt.own = attempt.region = 0;
  attempt.set.for_each([&](std::size_t p) {
    if (!shows(warp, p, k)) return;
    attempt.points += warp.seen[p];
    attempt.own += warp.seen[p] * patch_deviation(patches, warp, p, attempt.pose);
    attempt.region += warp.seen[p] * patch_deviation(patches, warp, p, region);
  });
}

std::size_t pick_seeds(const PatchTables& patches, const PatchWarp& warp, std::int8_t k,
                       const RigidTransform& region, double moved,
                       std::array<std::size_t, kSeeds>& seeds) noexcept {
  std::size_t count = 0;
  std::array<double, kSeeds> worth{};
  for (std::size_t p = 0; p < patches.count; ++p) {
    if (!shows(warp, p, k)) continue;
    const double deviation = patch_deviation(patches, warp, p, region);
    if (deviation < moved * moved) continue;
    std::size_t place = count;
    while (place > 0 && worth[place - 1] < deviation) --place;
    if (place == kSeeds) continue;
    if (count < kSeeds) ++count;
    for (std::size_t j = count - 1; j > place; --j) {
      worth[j] = worth[j - 1];
      seeds[j] = seeds[j - 1];
    }
    worth[place] = deviation;
    seeds[place] = p;
  }
  return count;
}

/// A part moved by more than this share of the inlier limit, in the mean square.
constexpr double kMoved = 0.6;

/// A part explains this much of what moved about it: around a joint that is all but the skin there. Of what
/// bends, one motion explains a piece: of a pressed ear seldom more than two thirds.
constexpr double kMostOfWhatMoved = 0.7;

/// Share of what moved by `least` or more, connected with the part, that is of the part.
double explained_share(const PatchTables& patches, const PatchWarp& warp, std::int8_t k,
                       const RigidTransform& region, const Attempt& attempt, double least) noexcept {
  double all = attempt.points;
  (void)flood(patches, attempt.set, [&](std::size_t, std::size_t q) {
    if (!counts(warp, q, k) || patch_deviation(patches, warp, q, region) < least * least) return false;
    all += warp.seen[q];
    return true;
  });
  return attempt.points / all;
}

}  // namespace

double patch_deviation(const PatchTables& patches, const PatchWarp& warp, std::size_t p,
                       const RigidTransform& pose) noexcept {
  const RigidTransform& own = warp.pose[p];
  const double shift = (own * patches.centres[p] - pose * patches.centres[p]).squaredNorm();
  // points of a disc turn by radius / 2 times the angle in the mean square
  const double turn = (own.rotation - pose.rotation).squaredNorm() * 0.5;
  return shift + kRotationSupport * 0.25 * patches.radius * patches.radius * turn;
}

Hold hold_of(const PatchTables& patches, const PatchWarp& warp, std::int8_t k, const RigidTransform& pose,
             double limit) noexcept {
  Hold hold;
  for (std::size_t p = 0; p < patches.count; ++p) {
    if (!counts(warp, p, k)) continue;
    hold.seen += warp.seen[p];
    if (patch_deviation(patches, warp, p, pose) > kDeviation * kDeviation * limit * limit) continue;
    hold.standing += warp.seen[p];
    hold.patches.add(p);
  }
  return hold;
}

RigidTransform fit_patches(const PatchTables& patches, const PatchWarp& warp, const PatchSet& set,
                           const RigidTransform& start) noexcept {
  RigidTransform pose = start;
  const double arm = std::sqrt(kRotationSupport) * 0.5 * patches.radius;
  for (int round = 0; round < kFitRounds; ++round) {
    Vector3 middle = Vector3::Zero();
    double weight = 0;
    set.for_each([&](std::size_t p) {
      middle += warp.seen[p] * (pose * patches.centres[p]);
      weight += warp.seen[p];
    });
    if (!(weight > 0)) return pose;
    middle /= weight;
    Symmetric6 a;
    Vector6 b = Vector6::Zero();
    set.for_each([&](std::size_t p) {
      if (!(warp.seen[p] > 0)) return;
      const double w = warp.seen[p];
      const Vector3 at = pose * patches.centres[p], gap = warp.pose[p] * patches.centres[p] - at;
      a.add_point_spring(w, at - middle);
      b.head<3>() += w * Vector3(at - middle).cross(gap);
      b.tail<3>() += w * gap;
      a.add_turn_spring(w * arm * arm);
      b.head<3>() += w * arm * arm * turn_between(warp.pose[p].rotation, pose.rotation);
    });
    Factor6 factor;
    if (!factor.factorise(a)) return pose;
    pose = motion_about(factor.solve(b), middle) * pose;
    pose.rotation = orthonormalised(pose.rotation);
  }
  return pose;
}

bool find_rigid_part(const PatchTables& patches, const PatchWarp& warp, std::int8_t k,
                     const RigidTransform& region, const PartSearchSettings& settings,
                     RigidPart& part) noexcept {
  const double moved = kMoved * settings.limit;
  std::array<std::size_t, kSeeds> seeds{};
  const std::size_t seed_count = pick_seeds(patches, warp, k, region, moved, seeds);
  const bool adrift = hold_of(patches, warp, k, region, settings.limit).lost();
  double best = 0;
  for (std::size_t s = 0; s < seed_count; ++s) {
    Attempt attempt;
    attempt.pose = warp.pose[seeds[s]];
    const double give =
        std::min(kDeviation * settings.limit,
                 kShareOfMotion * std::sqrt(patch_deviation(patches, warp, seeds[s], region)));
    for (int round = 0; round < kRounds; ++round) {
      const PatchSet grown = grow(patches, warp, k, seeds[s], attempt.pose, region, give);
      if (grown == attempt.set) break;
      attempt.set = grown;
      attempt.pose = fit_patches(patches, warp, attempt.set, attempt.pose);
    }
    measure(patches, warp, k, region, attempt);
    if (attempt.points < settings.fewest_points) continue;
    const double own = std::sqrt(attempt.own / attempt.points),
                 off = std::sqrt(attempt.region / attempt.points);
    if (off < moved || off < 2 * own || attempt.region - attempt.own <= best ||
        (!adrift && explained_share(patches, warp, k, region, attempt, give) < kMostOfWhatMoved))
      continue;
    if (!tells_its_motion(patches, warp, attempt.set, attempt.pose)) continue;
    best = attempt.region - attempt.own;
    part.patches = attempt.set;
    part.pose = attempt.pose;
  }
  return best > 0;
}

}  // namespace pliant

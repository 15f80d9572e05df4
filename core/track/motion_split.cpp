#include "core/track/motion_split.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pliant {

namespace {

constexpr double kPriorRotation = 0.2;      // radians between two frames' fits, one standard deviation
constexpr double kPriorTranslation = 0.02;  // metres
constexpr std::size_t kSeeds = 6;
constexpr int kRounds = 4;
constexpr double kFewestInPatch = 4;  // weighted points from which a patch has a say
constexpr std::int32_t kWidest =
    24 * kUnitsPerMillimetre * 16;  // residuals farther off say nothing, 1/256 mm

/// The set's sums.
struct Sum {
  Matrix6 a = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  double points = 0;

  void add(const PatchEnergy& e) noexcept {
    a += e.a;
    b += e.b;
    points += e.points;
  }
  [[nodiscard]] Vector6 best(double noise) const noexcept {
    Matrix6 m = a;
    for (int i = 0; i < 6; ++i) {
      const double sigma = i < 3 ? kPriorRotation : kPriorTranslation;
      m(i, i) += noise * noise / (sigma * sigma);
    }
    return m.ldlt().solve(b);
  }
};

PatchEnergy to_energy(const PlaneMoments& m) noexcept {
  constexpr double kArm = 1 / kUnitsPerMetre, kNormal = 1 / 16384.0, kWeight = 1 / 256.0,
                   kResidual = 1 / 256000.0;
  PatchEnergy e;
  std::size_t k = 0;
  for (int row = 0; row < 6; ++row) {
    const double unit_row = row < 3 ? kArm : kNormal;
    for (int column = row; column < 6; ++column) {
      const double unit_column = column < 3 ? kArm : kNormal;
      e.a(row, column) = static_cast<double>(m.a[k++]) * unit_row * unit_column * kWeight;
      e.a(column, row) = e.a(row, column);
    }
    e.b[row] = static_cast<double>(m.b[static_cast<std::size_t>(row)]) * unit_row * kWeight * kResidual;
  }
  e.c = static_cast<double>(m.square) * kWeight * kResidual * kResidual;
  e.points = static_cast<double>(m.weight) * kWeight;
  return e;
}

RigidTransform motion_about(const Vector6& x, const Vector3& centre) noexcept {
  RigidTransform step;
  step.rotation = rotation_from_small_vector(x.head<3>());
  step.translation = centre + Vector3(x.tail<3>()) - step.rotation * centre;
  return step;
}

struct Attempt {
  PatchSet part;
  Vector6 part_motion, rest_motion;
  double gain = 0;  // of energy, against one motion for all
  double part_before = 0, part_after = 0, part_points = 0, rest_points = 0;
};

class Search {
 public:
  Search(const PatchTables& patches, const MotionSplit& split, double noise) noexcept
      : patches_(patches), split_(split), noise_(noise) {}

  [[nodiscard]] bool counts(std::size_t p) const noexcept {
    return split_.energy[p].points >= kFewestInPatch;
  }

  /// Grows a part from `seed`.
  [[nodiscard]] Attempt grow(std::size_t seed) const noexcept {
    Attempt attempt;
    attempt.part.add(seed);
    for (std::size_t p = 0; p < patches_.count; ++p)
      if (patches_.neighbours[seed].has(p) && counts(p)) attempt.part.add(p);
    for (int round = 0; round < kRounds; ++round) {
      solve(attempt);
      if (round + 1 == kRounds) break;
      PatchSet grown;
      spread(seed, attempt, grown);
      if (grown == attempt.part) break;
      attempt.part = grown;
    }
    return attempt;
  }

 private:
  void solve(Attempt& attempt) const noexcept {
    Sum part, rest, all;
    for (std::size_t p = 0; p < patches_.count; ++p) {
      if (!counts(p)) continue;
      (attempt.part.has(p) ? part : rest).add(split_.energy[p]);
      all.add(split_.energy[p]);
    }
    attempt.part_motion = part.best(noise_);
    attempt.rest_motion = rest.best(noise_);
    const Vector6 one = all.best(noise_);
    attempt.part_points = part.points;
    attempt.rest_points = rest.points;
    attempt.gain = attempt.part_before = attempt.part_after = 0;
    for (std::size_t p = 0; p < patches_.count; ++p) {
      if (!counts(p)) continue;
      const PatchEnergy& e = split_.energy[p];
      const bool mine = attempt.part.has(p);
      attempt.gain += e.at(one) - e.at(mine ? attempt.part_motion : attempt.rest_motion);
      if (!mine) continue;
      attempt.part_before += e.at(attempt.rest_motion);
      attempt.part_after += e.at(attempt.part_motion);
    }
  }

  /// Patches that the part's motion suits better than the rest's, connected with the seed.
  void spread(std::size_t seed, const Attempt& attempt, PatchSet& grown) const noexcept {
    std::array<std::uint8_t, kMaxPatches> queue{};
    std::size_t head = 0, tail = 0;
    grown.add(seed);
    queue[tail++] = static_cast<std::uint8_t>(seed);
    while (head < tail) {
      const std::size_t p = queue[head++];
      for (std::size_t q = 0; q < patches_.count; ++q) {
        if (!patches_.neighbours[p].has(q) || grown.has(q) || !counts(q)) continue;
        const PatchEnergy& e = split_.energy[q];
        if (e.at(attempt.part_motion) >= e.at(attempt.rest_motion)) continue;
        grown.add(q);
        queue[tail++] = static_cast<std::uint8_t>(q);
      }
    }
  }

  const PatchTables& patches_;
  const MotionSplit& split_;
  double noise_;
};

/// The patches with the largest mean energy, largest first.
std::size_t pick_seeds(const PatchTables& patches, const MotionSplit& split,
                       std::array<std::size_t, kSeeds>& seeds) noexcept {
  std::size_t count = 0;
  std::array<double, kSeeds> worth{};
  for (std::size_t p = 0; p < patches.count; ++p) {
    const PatchEnergy& e = split.energy[p];
    if (e.points < kFewestInPatch) continue;
    const double mean = e.c / e.points;
    std::size_t place = count;
    while (place > 0 && worth[place - 1] < mean) --place;
    if (place == kSeeds) continue;
    if (count < kSeeds) ++count;
    for (std::size_t j = count - 1; j > place; --j) {
      worth[j] = worth[j - 1];
      seeds[j] = seeds[j - 1];
    }
    worth[place] = mean;
    seeds[place] = p;
  }
  return count;
}

}  // namespace

bool find_motion_split(const ModelTables& model, const PatchTables& patches, const RegionSet& regions,
                       std::int8_t k, const MotionSplitSettings& settings, const PointState& points,
                       MotionSplit& split) noexcept {
  std::int64_t sx = 0, sy = 0, sz = 0, count = 0;
  const auto all = points.correspondences.first(points.correspondence_count);
  for (const Correspondence& c : all) {
    if (c.region != k) continue;
    sx += c.point.x;
    sy += c.point.y;
    sz += c.point.z;
    ++count;
  }
  if (count < 2 * settings.fewest_points) return false;
  const IntPoint centre{static_cast<std::int32_t>(sx / count), static_cast<std::int32_t>(sy / count),
                        static_cast<std::int32_t>(sz / count)};
  for (std::size_t p = 0; p < patches.count; ++p) split.moments[p] = PlaneMoments();
  for (const Correspondence& c : all) {
    if (c.region != k || std::abs(c.residual) > kWidest) continue;
    const std::int32_t px = c.point.x - centre.x, py = c.point.y - centre.y, pz = c.point.z - centre.z;
    split.moments[patches.patch_of[c.index]].add(
        {(py * c.nz - pz * c.ny) >> 14, (pz * c.nx - px * c.nz) >> 14, (px * c.ny - py * c.nx) >> 14, c.nx,
         c.ny, c.nz},
        c.residual, 256);
  }
  for (std::size_t p = 0; p < patches.count; ++p) split.energy[p] = to_energy(split.moments[p]);

  std::array<std::size_t, kSeeds> seeds{};
  const std::size_t seed_count = pick_seeds(patches, split, seeds);
  const Search search(patches, split, settings.noise);
  Attempt best;
  for (std::size_t s = 0; s < seed_count; ++s) {
    const Attempt attempt = search.grow(seeds[s]);
    if (attempt.gain > best.gain) best = attempt;
  }
  if (best.gain <= 0 || best.part_points < settings.fewest_points ||
      best.rest_points < settings.fewest_points)
    return false;
  // The part must follow its motion as closely as noise allows, and clearly not the rest's.
  split.part_rms_before = std::sqrt(std::max(0.0, best.part_before / best.part_points));
  split.part_rms = std::sqrt(std::max(0.0, best.part_after / best.part_points));
  if (split.part_rms > 2.0 * settings.noise || split.part_rms_before < 2 * split.part_rms ||
      split.part_rms_before < settings.moved)
    return false;

  const Vector3 centre_metres(centre.x / kUnitsPerMetre, centre.y / kUnitsPerMetre,
                              centre.z / kUnitsPerMetre);
  split.part = best.part;
  split.part_motion = motion_about(best.part_motion, centre_metres);
  split.rest_motion = motion_about(best.rest_motion, centre_metres);
  (void)model;
  (void)regions;
  return true;
}

}  // namespace pliant

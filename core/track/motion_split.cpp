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

struct Attempt {
  std::size_t seed = 0;
  PatchSet part;
  Vector6 part_motion, rest_motion;
  PatchEnergy part_energy, rest_energy;
  double gain = 0;         // of energy, against one motion for all
  double part_before = 0;  // energy of the part under the rest's motion
};

class Search {
 public:
  Search(const PatchTables& patches, const MotionSplit& split, double noise) noexcept
      : patches_(patches), split_(split), noise_(noise) {}

  [[nodiscard]] bool counts(std::size_t p) const noexcept {
    return split_.energy[p].points >= kFewestInPatch;
  }

  /// `seed` and the patches around it, with the motion that suits them.
  [[nodiscard]] Attempt begin(std::size_t seed) const noexcept {
    Attempt attempt;
    attempt.seed = seed;
    attempt.part.add(seed);
    for (std::size_t p = 0; p < patches_.count; ++p)
      if (patches_.neighbours[seed].has(p) && counts(p)) attempt.part.add(p);
    solve(attempt);
    return attempt;
  }

  /// Lets the part take in and give off patches until it stays.
  void grow(Attempt& attempt) const noexcept {
    for (int round = 0; round < kRounds; ++round) {
      PatchSet grown;
      spread(attempt.seed, attempt, grown);
      if (grown == attempt.part) break;
      attempt.part = grown;
      solve(attempt);
    }
  }

 private:
  void solve(Attempt& attempt) const noexcept {
    PatchEnergy part, rest;
    for (std::size_t p = 0; p < patches_.count; ++p)
      if (counts(p)) (attempt.part.has(p) ? part : rest) += split_.energy[p];
    PatchEnergy all = part;
    all += rest;
    attempt.part_motion = best_motion(part, noise_, nullptr);
    attempt.rest_motion = best_motion(rest, noise_, nullptr);
    const Vector6 one = best_motion(all, noise_, nullptr);
    attempt.gain = all.at(one) - part.at(attempt.part_motion) - rest.at(attempt.rest_motion);
    attempt.part_before = part.at(attempt.rest_motion);
    attempt.part_energy = part;
    attempt.rest_energy = rest;
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

/// The seeds with the largest gain, largest first.
std::size_t pick_seeds(const PatchTables& patches, const Search& search,
                       std::array<std::size_t, kSeeds>& seeds) noexcept {
  std::size_t count = 0;
  std::array<double, kSeeds> worth{};
  for (std::size_t p = 0; p < patches.count; ++p) {
    if (!search.counts(p)) continue;
    const double gain = search.begin(p).gain;
    std::size_t place = count;
    while (place > 0 && worth[place - 1] < gain) --place;
    if (place == kSeeds) continue;
    if (count < kSeeds) ++count;
    for (std::size_t j = count - 1; j > place; --j) {
      worth[j] = worth[j - 1];
      seeds[j] = seeds[j - 1];
    }
    worth[place] = gain;
    seeds[place] = p;
  }
  return count;
}

/// The part must follow its motion as closely as noise allows, and clearly not the rest's.
bool significant(const Attempt& attempt, const MotionSplitSettings& settings) noexcept {
  const double points = attempt.part_energy.points;
  if (attempt.gain <= 0 || points < settings.fewest_points ||
      attempt.rest_energy.points < settings.fewest_points)
    return false;
  const double before = std::sqrt(std::max(0.0, attempt.part_before / points));
  const double after = std::sqrt(std::max(0.0, attempt.part_energy.at(attempt.part_motion) / points));
  return after <= 2.0 * settings.noise && before >= 2 * after && before >= settings.moved;
}

}  // namespace

Vector6 best_motion(const PatchEnergy& energy, double noise, const JointSpring* spring) noexcept {
  Matrix6 a = energy.a;
  Vector6 b = energy.b;
  for (int i = 0; i < 6; ++i) {
    const double sigma = i < 3 ? kPriorRotation : kPriorTranslation;
    a(i, i) += noise * noise / (sigma * sigma);
  }
  if (spring != nullptr) {
    Eigen::Matrix<double, 3, 6> j;  // displacement at the joint: w × arm + t
    const Vector3& m = spring->arm;
    j << 0, m.z(), -m.y(), 1, 0, 0,  //
        -m.z(), 0, m.x(), 0, 1, 0,   //
        m.y(), -m.x(), 0, 0, 0, 1;
    a += spring->stiffness * (j.transpose() * j);
    b += spring->stiffness * (j.transpose() * spring->displacement);
  }
  return a.ldlt().solve(b);
}

RigidTransform motion_about(const Vector6& x, const Vector3& centre) noexcept {
  RigidTransform step;
  step.rotation = rotation_from_small_vector(x.head<3>());
  step.translation = centre + Vector3(x.tail<3>()) - step.rotation * centre;
  return step;
}

bool find_motion_split(const PatchTables& patches, std::int8_t k, const MotionSplitSettings& settings,
                       const PointState& points, MotionSplit& split) noexcept {
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
    const std::int32_t residual =
        c.residual - points.misfit[c.index];  // what the model always gets wrong is no motion
    if (c.region != k || std::abs(residual) >= kWidest) continue;
    const std::int32_t px = c.point.x - centre.x, py = c.point.y - centre.y, pz = c.point.z - centre.z;
    split.moments[patches.patch_of[c.index]].add(
        {(py * c.nz - pz * c.ny) >> 14, (pz * c.nx - px * c.nz) >> 14, (px * c.ny - py * c.nx) >> 14, c.nx,
         c.ny, c.nz},
        residual, tukey_weight(residual, kWidest));
  }
  for (std::size_t p = 0; p < patches.count; ++p) split.energy[p] = to_energy(split.moments[p]);

  const Search search(patches, split, settings.noise);
  std::array<std::size_t, kSeeds> seeds{};
  const std::size_t seed_count = pick_seeds(patches, search, seeds);
  Attempt best;
  for (std::size_t s = 0; s < seed_count; ++s) {
    Attempt attempt = search.begin(seeds[s]);
    search.grow(attempt);
    if (significant(attempt, settings) && attempt.gain > best.gain) best = attempt;
  }
  if (best.gain <= 0) return false;
  split.part = best.part;
  split.part_energy = best.part_energy;
  split.rest_energy = best.rest_energy;
  split.centre = Vector3(centre.x / kUnitsPerMetre, centre.y / kUnitsPerMetre, centre.z / kUnitsPerMetre);
  return true;
}

}  // namespace pliant

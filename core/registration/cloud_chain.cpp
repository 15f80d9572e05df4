#include "core/registration/cloud_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/detect/fast_transform.hpp"
#include "core/registration/cloud_align.hpp"

namespace pliant {

namespace {

constexpr std::size_t kCoarsePoints = 500;
constexpr std::size_t kScorePoints = 600;
constexpr std::size_t kFinePoints = 2500;
constexpr std::size_t kSpeck = 6;           // points: fewer off their surroundings are noise
constexpr std::size_t kSingleFrames = 256;  // matches whose own poses are tried

Vector3 to_vector(const Point3f& p) noexcept {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

/// Distance between model keypoints: so far a right match may be off.
double key_spacing(const RegistrationState& s) noexcept {
  return s.model.spacing() * std::sqrt(static_cast<double>(s.model.size()) /
                                       static_cast<double>(std::max<std::size_t>(1, s.model_key_count)));
}

double match_tolerance(const RegistrationState& s) noexcept {
  return 1.5 * std::max(key_spacing(s), s.spacing);
}

double working_reach(const RegistrationState& s) noexcept {
  return 1.5 * std::max(s.support / 9, s.spacing);
}

CloudTarget working_target(const RegistrationState& s) noexcept {
  return {&s.working_grid, s.working.first(s.working_count), s.working_normals.first(s.working_count),
          s.working_taken.first(s.working_count)};
}

CloudTarget base_target(const RegistrationState& s) noexcept {
  return {&s.base_grid, s.base.first(s.base_count), {}, s.base_taken.first(s.base_count)};
}

double score_of(const RegistrationState& s, const RigidTransform& pose) noexcept {
  const std::size_t count = std::min(kScorePoints, s.model.size());
  return cloud_agreement(s.model, s.prefix.first(count), working_target(s), pose, match_tolerance(s),
                         working_reach(s)) /
         static_cast<double>(count);
}

/// Matches whose model point wanted(index) and whose scene point no instance or region explains.
template <typename Wanted>
std::size_t collect_matches(RegistrationState& s, Wanted&& wanted) noexcept {
  const auto near = static_cast<float>(s.spacing);
  std::size_t count = 0;
  for (std::size_t k = 0; k < s.posed_count; ++k) {
    if (!wanted(s.matches[k].model)) continue;
    float square = 0;
    if (s.base_grid.nearest_if(s.posed[k].scene, near, square,
                               [&](std::uint32_t i) { return s.base_taken[i] != 0; }) != PointGrid::kNone)
      continue;
    s.posed_left[count++] = s.posed[k];
  }
  return count;
}

/// A pose on trial.
struct Trial {
  RigidTransform pose;
  double score = -1;
};

void try_pose(const RegistrationState& s, RigidTransform pose, double gate, Trial& best) noexcept {
  if (s.settings.refinement) {
    const double tolerance = match_tolerance(s);
    const AlignSettings coarse = {gate, tolerance, working_reach(s), 8};
    const std::size_t count = std::min(kCoarsePoints, s.model.size());
    static_cast<void>(align_to_cloud(s.model, s.prefix.first(count), working_target(s), coarse, pose));
  }
  const double score = score_of(s, pose);
  if (score > best.score) best = {pose, score};
}

/// Poses that single matches propose by their local frames, the best matches first.
void try_single_frames(RegistrationState& s, std::span<const PosedMatch> matches, Trial& best) noexcept {
  std::array<Trial, 8> top;
  const double coarse = 0.08 * s.model.radius();
  const std::size_t step = std::max<std::size_t>(1, matches.size() / kSingleFrames);
  const std::size_t count = std::min<std::size_t>(100, s.model.size());
  for (std::size_t k = 0; k < matches.size(); k += step) {
    Trial trial;
    trial.pose = pose_from_frames(matches[k]);
    trial.score = cloud_agreement(s.model, s.prefix.first(count), working_target(s), trial.pose, coarse,
                                  std::max(coarse, working_reach(s)));
    for (Trial& held : top)
      if (trial.score > held.score) std::swap(trial, held);
  }
  for (const Trial& trial : top)
    if (trial.score >= 0) try_pose(s, trial.pose, coarse, best);
}

/// The last touch: on all scene points, with a gate of a spacing and a half or four times the noise.
void refine(const RegistrationState& s, std::span<const std::uint16_t> which, double noise,
            RigidTransform& pose) noexcept {
  if (!s.settings.refinement) return;
  const double last = std::max(1.5 * s.spacing, 4 * noise);
  const AlignSettings fine = {std::max(match_tolerance(s), last), last, 1.5 * s.spacing, 10};
  RigidTransform refined = pose;
  if (align_to_cloud(s.model, which, base_target(s), fine, refined) > 0) pose = refined;
}

/// Takes the readings of the scene under a pose.
void measure(RegistrationState& s, const RigidTransform& pose, double noise, bool only_free) noexcept {
  const std::span<const std::uint8_t> taken =
      only_free ? std::span<const std::uint8_t>(s.base_taken.first(s.base_count))
                : std::span<const std::uint8_t>();
  s.readings.measure(s.model, s.model_index, s.base.first(s.base_count), taken, pose, 1.5 * s.spacing,
                     std::max(2.5 * s.spacing, 4 * noise));
}

/// Median of the readings' spread: the scene's noise, metres. After measure().
double scene_noise(RegistrationState& s) noexcept {
  std::size_t count = 0;
  const std::size_t most = std::min<std::size_t>(800, s.model.size());
  for (std::size_t i = 0; i < most; ++i) {
    const SurfaceGap gap = s.readings.gap(s.model, i);
    if (gap.count >= 4) s.scratch[count++] = gap.spread;
  }
  if (count < 20) return 0;
  std::nth_element(s.scratch.begin(), s.scratch.begin() + static_cast<std::ptrdiff_t>(count / 2),
                   s.scratch.begin() + static_cast<std::ptrdiff_t>(count));
  return static_cast<double>(s.scratch[count / 2]);
}

/// How far a point's surroundings are off the surface as a share of what is allowed: a spacing, or four times
/// what noise leaves of the mean of the readings. Negative where the scene shows nothing. After measure().
float off_surface(const RegistrationState& s, std::size_t i, double noise) noexcept {
  const SurfaceGap gap = s.readings.gap(s.model, i);
  if (gap.count == 0) return -1;
  const double left = 4 * noise / std::sqrt(static_cast<double>(gap.count));
  return static_cast<float>(static_cast<double>(std::fabs(gap.along)) / std::max(s.model.spacing(), left));
}

bool on_surface(float off) noexcept {
  return off >= 0 && off <= 1;
}

/// Marks the scene points that lie on the region's points.
void take_points(RegistrationState& s, const InstanceBuffers& buffers, std::int8_t label,
                 const RigidTransform& pose, double noise) noexcept {
  const FastTransform back(pose.inverse());
  const auto across = static_cast<float>(1.5 * s.spacing);
  const auto deep = static_cast<float>(std::max(s.model.spacing(), 3 * noise));
  const float reach = std::sqrt(across * across + deep * deep);
  for (std::size_t j = 0; j < s.base_count; ++j) {
    if (s.base_taken[j] != 0) continue;
    const Point3f p = back.point(s.base[j]);
    float square = 0;
    const std::uint32_t i = s.model_index.nearest(p, reach, square);
    if (i == PointGrid::kNone || buffers.labels[i] != label) continue;
    const Point3f& m = s.model.positions()[i];
    const Normal16& n = s.model.normals()[i];
    const float along = (static_cast<float>(n.x) * (p.x - m.x) + static_cast<float>(n.y) * (p.y - m.y) +
                         static_cast<float>(n.z) * (p.z - m.z)) *
                        (1.0F / 16384);
    if (std::fabs(along) <= deep) s.base_taken[j] = 1;
  }
}

/// Open model points, the first `most` in the model's order (evenly spread), to s.part.
std::size_t open_part(RegistrationState& s, std::size_t most) noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < s.model.size() && count < most; ++i)
    if (s.open[i] != 0) s.part[count++] = static_cast<std::uint16_t>(i);
  return count;
}

struct Gain {
  std::uint32_t points = 0;  // of the largest connected piece
  std::uint32_t piece = 0;
};

/// What a pose explains of the open points: the largest connected piece, which must hang on the base:
/// somewhere the two transforms agree within a sixth of the radius.
Gain gain_of(RegistrationState& s, const RigidTransform& pose, const RigidTransform& base,
             double noise) noexcept {
  measure(s, pose, noise, true);
  for (std::size_t i = 0; i < s.model.size(); ++i) s.off[i] = s.open[i] != 0 ? off_surface(s, i, noise) : -1;
  Gain gain;
  gain.piece = s.islands.pieces(
      s.model, [&](std::size_t i) { return on_surface(s.off[i]); }, gain.points);
  double least = 1e300;
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    if (s.islands.piece()[i] != gain.piece || gain.piece == 0) continue;
    const Vector3 p = to_vector(s.model.positions()[i]);
    const Vector3 apart = pose * p - base * p;
    least = std::min(least, apart.dot(apart));
  }
  if (least > s.model.radius() * s.model.radius() / 36) gain.points = 0;
  return gain;
}

/// One more rigid region among the open points; false when there is none. Its points are
/// marked in s.proposal: all of them that its pose explains in pieces worth the name.
bool find_region(RegistrationState& s, const RigidTransform& base, double noise,
                 RigidTransform& pose) noexcept {
  const auto least = static_cast<std::uint32_t>(std::max(40.0, 0.02 * static_cast<double>(s.model.size())));
  std::array<MatchGroup, 4> groups;
  const std::size_t matches = collect_matches(s, [&](std::size_t i) { return s.open[i] != 0; });
  GroupingSettings settings;
  settings.tolerance = match_tolerance(s);
  settings.use_frames = s.settings.frame_hypotheses;
  const std::size_t count = s.grouping.group(s.posed_left.first(matches), settings, s.model.radius(), groups);
  // Beside the groups: from the base's own pose, for parts that moved little.
  Gain best;
  for (std::size_t k = 0; k <= count; ++k) {
    RigidTransform trial = k < count ? groups[k].transform : base;
    const std::size_t part = open_part(s, kFinePoints);
    const double gate = k < count ? 2 * match_tolerance(s) : 0.1 * s.model.radius();
    const AlignSettings wide = {gate, match_tolerance(s), std::max(gate, 1.5 * s.spacing), 12};
    if (align_to_cloud(s.model, s.part.first(std::min<std::size_t>(part, 800)), base_target(s), wide,
                       trial) == 0)
      continue;
    refine(s, s.part.first(part), noise, trial);
    const Gain gain = gain_of(s, trial, base, noise);
    if (gain.points > best.points) {
      best = gain;
      pose = trial;
    }
    if (2 * best.points > part) break;  // most of what is open: nothing can beat it
  }
  if (best.points < least) return false;
  // Once more on the piece alone.
  for (int pass = 0; pass < 2; ++pass) {
    const Gain gain = gain_of(s, pose, base, noise);
    if (gain.points < least) return false;
    std::size_t part = 0;
    for (std::size_t i = 0; i < s.model.size() && part < kFinePoints; ++i)
      if (s.islands.piece()[i] == gain.piece) s.part[part++] = static_cast<std::uint16_t>(i);
    if (pass == 0) refine(s, s.part.first(part), noise, pose);
  }
  // Sizes of the pieces; two legs may hang together through the hip alone, which bends.
  for (std::size_t i = 0; i < s.model.size(); ++i) s.gap_nearest[i] = 0;
  for (std::size_t i = 0; i < s.model.size(); ++i)
    if (s.islands.piece()[i] != 0) ++s.gap_nearest[s.islands.piece()[i] - 1];
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    const std::uint32_t piece = s.islands.piece()[i];
    s.proposal[i] = piece != 0 && 4 * s.gap_nearest[piece - 1] >= least ? 1 : 0;
  }
  return true;
}

}  // namespace

double find_instance(RegistrationState& s, RigidTransform& pose) noexcept {
  const std::size_t matches = collect_matches(s, [](std::size_t) { return true; });
  const std::span<const PosedMatch> left = s.posed_left.first(matches);
  Trial best;
  if (s.settings.grouping) {
    std::array<MatchGroup, Grouping::kMostGroups> groups;
    GroupingSettings settings;
    settings.tolerance = match_tolerance(s);
    settings.use_frames = s.settings.frame_hypotheses;
    const std::size_t count = s.grouping.group(left, settings, s.model.radius(), groups);
    for (std::size_t k = 0; k < count; ++k) {
      // A group with a fraction of the best one's members and a clear winner before it need not be tried.
      if (best.score > 0.5 && 2 * groups[k].members < groups[0].members) break;
      if (best.score > 0.8) break;
      try_pose(s, groups[k].transform, 2 * match_tolerance(s), best);
    }
  }
  if (s.settings.frame_hypotheses && best.score < 0.3) try_single_frames(s, left, best);
  if (best.score < 0) return best.score;
  refine(s, s.prefix.first(std::min(kFinePoints, s.model.size())), 0, best.pose);
  pose = best.pose;
  return best.score;
}

namespace {

/// Where regions meet, a point belongs to the one whose surface is nearer; then each region is aligned on its
/// own points.
void settle_borders(RegistrationState& s, InstanceBuffers& buffers, std::span<RigidTransform> poses,
                    double noise) noexcept {
  const std::size_t n = s.model.size();
  for (int pass = 0; pass < 2; ++pass) {
    // s.off: the best so far; s.proposal: whose it is.
    for (std::size_t i = 0; i < n; ++i) {
      s.off[i] = 2;
      s.proposal[i] = static_cast<std::uint32_t>(kNotObserved + 2);
    }
    for (std::size_t r = 0; r < poses.size(); ++r) {
      measure(s, poses[r], noise, false);
      const auto label = static_cast<std::int8_t>(r);
      for (std::size_t i = 0; i < n; ++i) {
        bool beside = buffers.labels[i] == label;
        for (const std::uint16_t j : s.model.neighbours(i))
          beside = beside || (j != kNoNeighbour && buffers.labels[j] == label);
        if (!beside) continue;
        const float off = off_surface(s, i, noise);
        if (!on_surface(off) || off >= s.off[i]) continue;
        s.off[i] = off;
        s.proposal[i] = static_cast<std::uint32_t>(label + 2);
      }
    }
    for (std::size_t i = 0; i < n; ++i)
      buffers.labels[i] = static_cast<std::int8_t>(static_cast<int>(s.proposal[i]) - 2);
    s.islands.filter(s.model, static_cast<std::size_t>(0.005 * static_cast<double>(n)), buffers.labels,
                     [&](std::size_t i, std::int8_t label) { return label >= 0 && buffers.labels[i] >= 0; });
    for (std::size_t i = 0; i < s.base_count; ++i)
      s.base_taken[i] = static_cast<std::uint8_t>(s.base_taken[i] & 2);
    for (std::size_t r = 0; r < poses.size(); ++r) {
      std::size_t part = 0;
      for (std::size_t i = 0; i < n && part < kFinePoints; ++i)
        if (buffers.labels[i] == static_cast<std::int8_t>(r)) s.part[part++] = static_cast<std::uint16_t>(i);
      if (part >= 40) refine(s, s.part.first(part), noise, poses[r]);
    }
    for (std::size_t r = 0; r < poses.size(); ++r)
      take_points(s, buffers, static_cast<std::int8_t>(r), poses[r], noise);
  }
}

}  // namespace

void build_chain(RegistrationState& s, const RigidTransform& first, InstanceBuffers& buffers,
                 InstanceResult& instance) noexcept {
  const std::size_t n = s.model.size();
  std::array<RigidTransform, limits::kMaxRegions> poses;
  std::size_t regions = 1;
  poses[0] = first;
  measure(s, first, 0, false);
  const double noise = scene_noise(s);
  refine(s, s.prefix.first(std::min(kFinePoints, n)), noise, poses[0]);
  measure(s, poses[0], noise, false);
  std::uint32_t explained = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool on = on_surface(off_surface(s, i, noise));
    buffers.labels[i] = on ? std::int8_t{0} : kNotObserved;
    s.open[i] = on ? 0 : 1;
    explained += on ? 1 : 0;
  }
  take_points(s, buffers, 0, poses[0], noise);
  // The same again on the outliers.
  while (regions < s.settings.max_regions &&
         static_cast<double>(explained) < s.settings.wanted_share * static_cast<double>(n)) {
    if (!find_region(s, poses[0], noise, poses[regions])) break;
    const auto label = static_cast<std::int8_t>(regions);
    for (std::size_t i = 0; i < n; ++i)
      if (s.open[i] != 0 && s.proposal[i] != 0) {
        buffers.labels[i] = label;
        s.open[i] = 0;
        ++explained;
      }
    take_points(s, buffers, label, poses[regions], noise);
    ++regions;
  }
  if (regions > 1) settle_borders(s, buffers, {poses.data(), regions}, noise);
  // Specks within a region that miss its bound by little are its own: noise.
  measure(s, poses[0], noise, false);
  for (std::size_t i = 0; i < n; ++i) s.off[i] = off_surface(s, i, noise);
  s.islands.filter(s.model, kSpeck, buffers.labels, [&](std::size_t i, std::int8_t label) {
    return label == 0 && buffers.labels[i] < 0 && s.off[i] < 1.5F;
  });
  // The largest region is the base.
  std::array<std::uint32_t, limits::kMaxRegions> sizes{};
  for (std::size_t i = 0; i < n; ++i)
    if (buffers.labels[i] >= 0) ++sizes[static_cast<std::size_t>(buffers.labels[i])];
  std::array<std::int8_t, limits::kMaxRegions> rank{}, number{};
  for (std::size_t r = 0; r < regions; ++r) rank[r] = static_cast<std::int8_t>(r);
  std::sort(
      rank.begin(), rank.begin() + static_cast<std::ptrdiff_t>(regions), [&](std::int8_t a, std::int8_t b) {
        const std::uint32_t x = sizes[static_cast<std::size_t>(a)], y = sizes[static_cast<std::size_t>(b)];
        return x != y ? x > y : a < b;
      });
  for (std::size_t k = 0; k < regions; ++k)
    number[static_cast<std::size_t>(rank[k])] = static_cast<std::int8_t>(k);
  for (std::size_t i = 0; i < n; ++i)
    if (buffers.labels[i] >= 0) buffers.labels[i] = number[static_cast<std::size_t>(buffers.labels[i])];
  for (std::size_t k = 0; k < regions; ++k) {
    RegionResult& region = buffers.regions[k];
    region = RegionResult();
    region.id = static_cast<std::int8_t>(k);
    region.transform = poses[static_cast<std::size_t>(rank[k])];
  }
  instance.regions = buffers.regions.first(regions);
  for (std::size_t k = 0; k < regions; ++k) {
    RegionResult& region = buffers.regions[k];
    measure(s, region.transform, noise, false);
    for (std::size_t i = 0; i < n; ++i) {
      if (buffers.labels[i] != region.id) continue;
      s.gap_nearest[i] = s.readings.nearest(i);
      buffers.residuals[i] = s.readings.distance(i);
      const SurfaceGap gap = s.readings.gap(s.model, i);
      ++region.points;
      region.rms += static_cast<double>(gap.along * gap.along);
    }
  }
  for (std::size_t k = 0; k < regions; ++k)
    if (buffers.regions[k].points > 0)
      buffers.regions[k].rms = std::sqrt(buffers.regions[k].rms / buffers.regions[k].points);
}

void find_deformed(RegistrationState& s, InstanceBuffers& buffers, InstanceResult& instance) noexcept {
  const std::size_t n = s.model.size();
  // Every point starts where the nearest region (along the model's surface) takes it.
  for (std::size_t i = 0; i < n; ++i)
    s.proposal[i] =
        buffers.labels[i] >= 0 ? static_cast<std::uint32_t>(buffers.labels[i]) : limits::kMaxRegions;
  for (int sweep = 0; sweep < 64; ++sweep) {
    bool changed = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (s.proposal[i] != limits::kMaxRegions) continue;
      for (const std::uint16_t j : s.model.neighbours(i))
        if (j != kNoNeighbour && s.proposal[j] != limits::kMaxRegions) {
          s.proposal[i] = s.proposal[j];
          changed = true;
          break;
        }
    }
    if (!changed) break;
  }
  const auto radius = static_cast<float>(std::max(8 * s.spacing, 0.15 * s.model.radius()));
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t region = s.proposal[i] == limits::kMaxRegions ? 0 : s.proposal[i];
    const FastTransform fast(buffers.regions[region].transform);
    buffers.positions[i] = fast.point(s.model.positions()[i]);
    buffers.matches[i] = -1;
    if (buffers.labels[i] >= 0) {
      buffers.matches[i] = s.gap_nearest[i] == PointGrid::kNone
                               ? -1
                               : static_cast<std::int32_t>(s.base_index[s.gap_nearest[i]]);
      continue;
    }
    buffers.residuals[i] = 0;
  }
  // Each point without a match asks for its nearest free scene point whose surface faces its way; of several
  // that ask for one, the nearest gets it, and the others ask again.
  for (std::size_t j = 0; j < s.base_count; ++j) s.claimed[j] = 0;
  for (std::size_t i = 0; i < n; ++i) s.gap_nearest[i] = PointGrid::kNone;
  const Point3f eye = {static_cast<float>(s.eye.x()), static_cast<float>(s.eye.y()),
                       static_cast<float>(s.eye.z())};
  const auto working_reach_f = static_cast<float>(2 * working_reach(s));
  for (int pass = 0; pass < 6; ++pass) {
    bool asked = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (buffers.labels[i] >= 0 || s.gap_nearest[i] != PointGrid::kNone) continue;
      const std::size_t region = s.proposal[i] == limits::kMaxRegions ? 0 : s.proposal[i];
      const Point3f normal = FastTransform(buffers.regions[region].transform).direction(s.model.normals()[i]);
      const Point3f& p = buffers.positions[i];
      // What is turned away from the only eye cannot be seen.
      if (s.one_view && normal.x * (eye.x - p.x) + normal.y * (eye.y - p.y) + normal.z * (eye.z - p.z) <= 0)
        continue;
      float square = 0;
      const std::uint32_t j = s.base_grid.nearest_if(p, radius, square, [&](std::uint32_t k) {
        if (s.base_taken[k] != 0) return false;
        if (s.claimed[k] != 0) {
          const Point3f& q = buffers.positions[s.claimed[k] - 1];
          const Point3f& t = s.base[k];
          const float theirs =
              (q.x - t.x) * (q.x - t.x) + (q.y - t.y) * (q.y - t.y) + (q.z - t.z) * (q.z - t.z);
          const float mine =
              (p.x - t.x) * (p.x - t.x) + (p.y - t.y) * (p.y - t.y) + (p.z - t.z) * (p.z - t.z);
          if (mine >= theirs) return false;
        }
        float w = 0;
        const std::uint32_t near = s.working_grid.nearest(s.base[k], working_reach_f, w);
        if (near == PointGrid::kNone) return false;
        const Normal16& m = s.working_normals[near];
        return normal.x * static_cast<float>(m.x) + normal.y * static_cast<float>(m.y) +
                   normal.z * static_cast<float>(m.z) >
               0.5F * 16384;
      });
      if (j == PointGrid::kNone) continue;
      if (s.claimed[j] != 0) s.gap_nearest[s.claimed[j] - 1] = PointGrid::kNone;
      s.claimed[j] = static_cast<std::uint32_t>(i + 1);
      s.gap_nearest[i] = j;
      asked = true;
    }
    if (!asked) break;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (buffers.labels[i] >= 0) continue;
    buffers.labels[i] = s.gap_nearest[i] == PointGrid::kNone ? kNotObserved : kDeformed;
    if (s.gap_nearest[i] == PointGrid::kNone) continue;
    const Point3f& q = s.base[s.gap_nearest[i]];
    const Point3f& p = buffers.positions[i];
    buffers.residuals[i] =
        std::sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y) + (q.z - p.z) * (q.z - p.z));
    buffers.positions[i] = q;
    buffers.matches[i] = static_cast<std::int32_t>(s.base_index[s.gap_nearest[i]]);
  }
  // What the deformed points were matched with belongs to this instance too.
  for (std::size_t j = 0; j < s.base_count; ++j)
    if (s.claimed[j] != 0) s.base_taken[j] = 1;
  for (std::size_t j = 0; j < s.base_count; ++j)
    if (s.base_taken[j] != 0) s.base_taken[j] = 3;
  for (std::size_t j = 0; j < s.working_count; ++j) {
    float square = 0;
    const std::uint32_t i = s.base_grid.nearest(s.working[j], static_cast<float>(s.spacing), square);
    if (i != PointGrid::kNone && s.base_taken[i] != 0) s.working_taken[j] = 1;
  }
  instance.positions = buffers.positions;
  instance.labels = buffers.labels;
  instance.matches = buffers.matches;
  instance.residuals = buffers.residuals;
  instance.deformed = instance.unobserved = 0;
  for (const std::int8_t label : buffers.labels) {
    instance.deformed += label == kDeformed ? 1 : 0;
    instance.unobserved += label == kNotObserved ? 1 : 0;
  }
}

}  // namespace pliant

#include "core/track/label.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "core/deform/radius_search.hpp"
#include "core/fixed/integer_root.hpp"
#include "core/track/model_error.hpp"
#include "core/track/placed_points.hpp"
#include "core/track/sight.hpp"

namespace pliant {

namespace {

constexpr std::uint8_t kSwitchAt = 16;  // evidence that moves a point to another region: two clear frames

void raise(std::uint8_t& counter, int by, int most) noexcept {
  counter = static_cast<std::uint8_t>(std::clamp(counter + by, 0, most));
}

std::span<const std::uint16_t> neighbours_of(const ModelTables& model, std::size_t i) noexcept {
  return model.model->neighbours(i);
}

using HomeCounts = std::array<int, limits::kMaxRegions>;

HomeCounts homes_around(const ModelTables& model, const PointState& points, std::size_t i) noexcept {
  HomeCounts counts{};
  for (const std::uint16_t n : neighbours_of(model, i))
    if (n < model.size) ++counts[static_cast<std::size_t>(points.home[n])];
  return counts;
}

/// Weighs the point's own region against those of its neighbours and moves it when the evidence suffices.
/// Beside how well each explains the reading, every neighbour has a say: regions are parts of the surface,
/// not scattered points.
bool consider_rivals(const ModelTables& model, const RegionSet& regions, const Sighting& sighting,
                     const RegionPoses& poses, std::int32_t limit, const Sighting::Look& own,
                     std::uint8_t enough, PointState& points, std::size_t i) noexcept {
  const HomeCounts around = homes_around(model, points, i);
  const auto home = static_cast<std::size_t>(points.home[i]);
  const std::int32_t own_cost = own.sight == Sight::agrees ? std::abs(own.residual) : 2 * limit;
  std::int8_t best = -1;
  int best_gain = 0;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (k == home || !regions[k].alive || around[k] < 2) continue;
    const Sighting::Look other = sighting.look(i, poses[k]);
    if (other.sight != Sight::agrees) continue;
    const int gain = (own_cost - std::abs(other.residual)) * 8 / limit + around[k] - around[home];
    if (gain <= best_gain) continue;
    best = static_cast<std::int8_t>(k);
    best_gain = gain;
  }
  if (best < 0) {
    raise(points.switching[i], -4, kSwitchAt);
    return false;
  }
  if (points.rival[i] != best) {
    points.rival[i] = best;
    points.switching[i] = 0;
  }
  raise(points.switching[i], std::min(best_gain, 8), kSwitchAt);
  if (points.switching[i] < enough) return false;
  points.home[i] = best;
  points.switching[i] = 0;
  points.rival[i] = -1;
  points.evidence[i] = 0;
  return true;
}

/// A point that is not seen goes with the region, of those around it first, under which free space allows it.
/// True when that is another than its own.
bool carry_where_allowed(const ModelTables& model, const RegionSet& regions, const Sighting& sighting,
                         const RegionPoses& poses, PointState& points, std::size_t i) noexcept {
  const std::int8_t home = points.home[i];
  if (!sighting.refuted(i, poses[static_cast<std::size_t>(home)])) return false;
  const HomeCounts around = homes_around(model, points, i);
  int most = -1;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].alive || around[k] <= most || sighting.refuted(i, poses[k])) continue;
    most = around[k];
    points.home[i] = static_cast<std::int8_t>(k);
  }
  return points.home[i] != home;
}

/// What one frame says of one point.
struct Verdict {
  Sighting::Look look;        ///< at its region's place, or else where the warp puts it
  bool off = false;           ///< speaks for its being off its region
  bool turned = false;        ///< only the warp turns it towards the camera, near its region's place
  bool doubtful = false;      ///< but where its region puts it, there is a surface, too
  IntPoint rigid, warped;     ///< the two places
  std::int32_t distance = 0;  ///< between them
};

/// Below 2^15 on each axis: a model is smaller.
std::int32_t distance_of(const IntPoint& a, const IntPoint& b) noexcept {
  return static_cast<std::int32_t>(integer_sqrt(static_cast<std::uint32_t>(
      std::min<std::int64_t>(squared_distance(a, b), std::numeric_limits<std::uint32_t>::max()))));
}

/// Where a patch's readings take a point is known better than any one of them tells: three quarters of the
/// inlier limit, `limit`, 3 σ or more, put it off its region, which has it where `at_home` looks.
Verdict examine(const LabelContext& context, const WarpLanes& lanes, const Sighting& sighting,
                std::int32_t limit, std::int8_t region, const Sighting::Look& at_home,
                std::size_t i) noexcept {
  Verdict verdict;
  verdict.look = at_home;
  verdict.rigid = at_home.point;
  if (const std::size_t p = context.patches.patch_of[i];
      context.warp.rigid[p] && context.warp.home[p] == region) {
    verdict.warped = verdict.rigid;
    verdict.off = at_home.sight == Sight::in_front;
    return verdict;
  }
  verdict.warped = warped_point(context.model, context.patches, lanes, i);
  verdict.distance = distance_of(verdict.rigid, verdict.warped);
  const bool apart = verdict.distance * 4 > 3 * limit;
  if (at_home.sight == Sight::agrees && !apart) return verdict;
  if (!apart && verdict.distance * 4 < limit) {
    verdict.off = at_home.sight == Sight::in_front;
    return verdict;
  }
  const FixedPose& own = context.warp.fixed[context.patches.patch_of[i]];
  Sighting::Look at_warp = sighting.look(
      verdict.warped, own.direction(context.model.nx[i], context.model.ny[i], context.model.nz[i]));
  // Beside an outline most often: it is matched by the radius search of deformed points.
  if (apart && at_warp.sight == Sight::none && at_home.sight != Sight::agrees &&
      at_home.sight != Sight::behind)
    (void)sighting.look_beside(kSearchLimits * limit, at_warp);
  verdict.doubtful = at_home.sight == Sight::agrees;
  verdict.turned = at_home.sight == Sight::none && !apart && at_warp.sight == Sight::agrees;
  verdict.off = (at_warp.sight == Sight::agrees && !verdict.turned) || at_home.sight == Sight::in_front;
  if (at_warp.sight == Sight::agrees || at_home.sight != Sight::agrees) verdict.look = at_warp;
  return verdict;
}

/// Where the point is: with its region, and the more with the warp the nearer that comes to the inlier limit;
/// a deformed point altogether, on its reading. Without one, off the model by `error` (1/16 mm) along its
/// normal.
IntPoint place(const Verdict& verdict, std::int8_t label, std::int32_t limit, std::int32_t error) noexcept {
  const IntPoint &r = verdict.rigid, &w = verdict.warped;
  if (label == kDeformed)
    return moved_along(w, verdict.look.normal,
                       verdict.look.sight == Sight::agrees ? verdict.look.residual : error);
  // small differences are noise; the warp moves a rigid point by no more than the limit
  const std::int32_t whole = label >= 0 ? std::max(verdict.distance, limit) : limit;
  const std::int32_t share = (std::min(verdict.distance, limit) << 14) / whole;  // Q14
  const auto part = [&](std::int32_t from, std::int32_t to) {
    return from + static_cast<std::int32_t>((static_cast<std::int64_t>(to - from) * share + 8192) >> 14);
  };
  return moved_along({part(r.x, w.x), part(r.y, w.y), part(r.z, w.z)}, verdict.look.normal, error);
}

/// Labels points one by one, and counts how they were seen.
class Labeller {
 public:
  Labeller(const LabelContext& context, const RegionSet& regions, PointState& points) noexcept
      : context_(context),
        regions_(regions),
        points_(points),
        poses_(fixed_poses(regions, context.model.centre)),
        lanes_(lanes_of(context.patches, context.warp)),
        sighting_(context.model, context.surface, context.projector, context.tolerance),
        noise_(context.tolerance.smoothed_noise(depth_of(regions[0].pose, context.model.centre))),
        several_(count_alive(regions) > 1) {}

  /// Every point; patch by patch, so that what stands together is placed together.
  void label_all() noexcept {
    const PatchPoints& by_patch = context_.model.by_patch;
    PlacedPoints placed;
    for (std::size_t p = 0; p < context_.patches.count; ++p) {
      const std::int8_t home = context_.warp.home[p];
      const bool border = several_ && context_.borders.has(p);
      const std::size_t begin = by_patch.begin[p], end = begin + by_patch.count[p];
      for (std::size_t first = begin; first < end; first += PlacedPoints::kMost) {
        const std::size_t count = std::min(PlacedPoints::kMost, end - first);
        placed.place({by_patch, first}, PatchPoints::filled_up(count),
                     poses_[static_cast<std::size_t>(home)]);
        for (std::size_t k = 0; k < count; ++k) {
          const std::size_t i = by_patch.index[first + k];
          label_point(
              i, border,
              points_.home[i] == home ? sighting_.look(placed.point(k), placed.normal(k)) : at_home(i));
        }
      }
    }
  }
  [[nodiscard]] const SightCounts& counts() const noexcept { return counts_; }

 private:
  [[nodiscard]] Sighting::Look at_home(std::size_t i) const noexcept {
    return sighting_.look(i, poses_[static_cast<std::size_t>(points_.home[i])]);
  }

  /// `look`: at its home's place. `border`: in a patch beside another region.
  void label_point(std::size_t i, bool border, Sighting::Look look) noexcept {
    const ModelTables& model = context_.model;
    const std::uint8_t enough_to_switch = context_.with_memory ? kSwitchAt : std::uint8_t{1};
    if (border &&
        consider_rivals(model, regions_, sighting_, poses_, context_.tolerance.deformed(look.point.z), look,
                        enough_to_switch, points_, i))
      look = at_home(i);
    if (several_ && look.sight == Sight::none &&
        carry_where_allowed(model, regions_, sighting_, poses_, points_, i)) {
      const FixedPose& pose = poses_[static_cast<std::size_t>(points_.home[i])];
      look.point = pose.point(model.x[i], model.y[i], model.z[i]);
      look.normal = pose.direction(model.nx[i], model.ny[i], model.nz[i]);
    }
    const std::int32_t limit = context_.tolerance.deformed(look.point.z);
    const Verdict verdict = examine(context_, lanes_, sighting_, limit, points_.home[i], look, i);
    weigh(i, verdict);
    decide(i, verdict, look.sight, limit);
  }

  /// What a frame adds to the evidence that a point is off its region, and to its misfit.
  void weigh(std::size_t i, const Verdict& verdict) noexcept {
    const Sight sight = verdict.look.sight;
    if (verdict.off) {
      raise(points_.evidence[i], verdict.doubtful ? 1 : 2, kEvidenceMax);
    } else if (sight == Sight::agrees) {
      raise(points_.evidence[i], -2, kEvidenceMax);
      points_.misfit[i] += (verdict.look.residual * 16 - points_.misfit[i]) /
                           (points_.frames <= kMisfitFirstFrames ? points_.frames : kMisfitFrames);
    } else if (points_.evidence[i] < kEvidenceDeformed) {
      raise(points_.evidence[i], -1, kEvidenceMax);
    }
    if (!context_.with_memory) points_.evidence[i] = verdict.off ? kEvidenceMax : std::uint8_t{0};
  }

  void decide(std::size_t i, const Verdict& verdict, Sight at_home, std::int32_t limit) noexcept {
    const Sight sight = verdict.look.sight;
    counts_.facing += verdict.look.facing ? 1 : 0;
    counts_.in_front += sight == Sight::in_front ? 1 : 0;
    counts_.behind += sight == Sight::behind ? 1 : 0;
    const bool off = points_.evidence[i] >= kEvidenceDeformed;
    const bool rigid = !off && sight == Sight::agrees && (at_home == Sight::agrees || verdict.turned);
    // Seen, but not where its region puts it, or known to be off it and the camera sees through its place
    // there.
    const bool deformed = !rigid && (sight == Sight::agrees || (off && sight == Sight::in_front));
    const std::int8_t label = rigid ? points_.home[i] : deformed ? kDeformed : kNotObserved;
    counts_.deformed += label == kDeformed && sight == Sight::agrees ? 1 : 0;
    points_.label[i] = label;
    points_.sight[i] = sight;
    const std::int32_t error = model_error(points_.misfit[i], noise_, limit);
    points_.residual[i] = label == kDeformed ? 0 : verdict.look.residual - error;
    points_.match[i] = sight == Sight::agrees ? verdict.look.match : -1;
    points_.position[i] = place(verdict, label, limit, error);
    const IntPoint &r = verdict.rigid, &at = points_.position[i];
    points_.offset[i] = {at.x - r.x, at.y - r.y, at.z - r.z};
  }

  const LabelContext& context_;
  const RegionSet& regions_;
  PointState& points_;
  RegionPoses poses_;
  WarpLanes lanes_;
  Sighting sighting_;
  std::int32_t noise_;  ///< Tolerance::smoothed_noise at the object
  bool several_;
  SightCounts counts_;
};

}  // namespace

SightCounts label(const LabelContext& context, const RegionSet& regions, PointState& points) noexcept {
  points.frames = std::min(points.frames + 1, kMisfitFirstFrames + 1);
  Labeller labeller(context, regions, points);
  labeller.label_all();
  return labeller.counts();
}

void carry_homes_to_unseen(const ModelTables& model, PointState& points) noexcept {
  std::size_t head = 0, tail = 0;
  for (std::size_t i = 0; i < model.size; ++i) {
    points.group[i] = points.sight[i] != Sight::none ? 1 : 0;
    if (points.group[i] != 0) points.queue[tail++] = static_cast<std::uint16_t>(i);
  }
  while (head < tail) {
    const std::size_t i = points.queue[head++];
    for (const std::uint16_t n : neighbours_of(model, i)) {
      if (n >= model.size || points.group[n] != 0) continue;
      points.group[n] = 1;
      points.home[n] = points.home[i];
      points.evidence[n] = 0;
      points.queue[tail++] = n;
    }
  }
}

}  // namespace pliant

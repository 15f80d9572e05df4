#include "core/track/regroup.hpp"

#include <algorithm>

#include "core/track/compare_poses.hpp"
#include "core/track/hand_over.hpp"
#include "core/track/model_error.hpp"
#include "core/track/part_split.hpp"
#include "core/track/region_tree.hpp"

namespace pliant {

namespace {

constexpr int kSwitchAfter = 2;  // frames in which a neighbouring region must suit a patch better

void dissolve(const RegroupContext& context, RegroupState& state, RegionSet& regions, PointState& points,
              std::size_t k, std::int8_t into) noexcept {
  const auto id = static_cast<std::int8_t>(k);
  give_points(context, id, into, -1, points);
  for (std::size_t i = 0; i < points.rival.size(); ++i)
    if (points.rival[i] == id) {
      points.rival[i] = -1;
      points.switching[i] = 0;
    }
  if (hangs_on(regions, into, id)) hang(regions, static_cast<std::size_t>(into), regions[k].parent);
  for (std::size_t r = 0; r < regions.size(); ++r)
    if (regions[r].alive && regions[r].parent == id) hang(regions, r, into);
  regions[k] = TrackedRegion();
  state.suspected[k] = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) state.alike[k][r] = state.alike[r][k] = 0;
}

/// Patches go over to the neighbouring region whose motion is theirs. True when one did.
bool switch_patches(const RegroupContext& context, RegroupState& state, const RegionSet& regions,
                    PointState& points) noexcept {
  bool any = false;
  for (std::size_t p = 0; p < context.patches.count; ++p) {
    const std::int8_t home = context.warp.home[p];
    std::int8_t best = home;
    if (patch_counts(context.warp, p)) {
      const double limit = limit_at(context, regions[static_cast<std::size_t>(home)].pose);
      const double own =
          patch_deviation(context.patches, context.warp, p, regions[static_cast<std::size_t>(home)].pose);
      // twice as near as the own region's motion, and within half of the inlier limit
      double least = std::min(0.25 * limit * limit, 0.25 * own);
      if (own > 0.1 * limit * limit)  // about a third of the limit: below, both may be right
        for (std::size_t q = 0; q < context.patches.count; ++q) {
          const std::int8_t other = context.warp.home[q];
          if (other == home || other == best || !context.patches.neighbours[p].has(q)) continue;
          const double deviation = patch_deviation(context.patches, context.warp, p,
                                                   regions[static_cast<std::size_t>(other)].pose);
          if (deviation >= least) continue;
          least = deviation;
          best = other;
        }
    }
    state.switching[p] = best == home ? std::uint8_t{0} : static_cast<std::uint8_t>(state.switching[p] + 1);
    if (state.switching[p] < kSwitchAfter) continue;
    state.switching[p] = 0;
    give_points(context, home, best, static_cast<int>(p), points);
    any = true;
  }
  return any;
}

bool is_seen(const RegroupContext& context, std::int8_t k) noexcept {
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k && patch_counts(context.warp, p)) return true;
  return false;
}

bool adjacent(const RegroupContext& context, std::int8_t a, std::int8_t b) noexcept {
  for (std::size_t k = 0; k < context.patches.border_count; ++k) {
    const std::int8_t x = context.warp.home[context.patches.borders[k].a],
                      y = context.warp.home[context.patches.borders[k].b];
    if ((x == a && y == b) || (x == b && y == a)) return true;
  }
  return false;
}

/// Does the region hang on no other any more? Somewhere along its borders a part stays within a patch's width
/// of what it is joined to, however it turns; a region that does not has lost its way.
bool torn_off(const RegroupContext& context, const RegionSet& regions, std::int8_t k) noexcept {
  bool any = false;
  for (std::size_t b = 0; b < context.patches.border_count; ++b) {
    const PatchBorder& border = context.patches.borders[b];
    const std::int8_t x = context.warp.home[border.a], y = context.warp.home[border.b];
    if (x == y || (x != k && y != k)) continue;
    any = true;
    const Vector3 gap = regions[static_cast<std::size_t>(x)].pose * border.centre -
                        regions[static_cast<std::size_t>(y)].pose * border.centre;
    if (gap.squaredNorm() <= 4 * context.patches.radius * context.patches.radius) return false;
  }
  return any;
}

/// Two regions become one when one motion suits both; the lower id stays. A region that lost its points or
/// was torn off goes, too.
bool merge(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
           RegionSet& regions, PointState& points) noexcept {
  for (std::size_t k = 1; k < regions.size(); ++k)
    if (regions[k].alive && (regions[k].members < settings.fewest_points / 2 ||
                             torn_off(context, regions, static_cast<std::int8_t>(k)))) {
      dissolve(context, state, regions, points, k, regions[k].parent);
      return true;
    }
  for (std::size_t b = 1; b < regions.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      std::uint8_t& alike = state.alike[a][b];
      const auto ia = static_cast<std::int8_t>(a), ib = static_cast<std::int8_t>(b);
      const bool a_larger = regions[a].members >= regions[b].members;
      // of what nobody sees, nothing tells that it moves alike
      if (!regions[a].alive || !regions[b].alive || !adjacent(context, ia, ib) ||
          !is_seen(context, a_larger ? ib : ia)) {
        alike = 0;
        continue;
      }
      const bool fits = worse_by(context.model, context.patches, context.sighting, points,
                                 {a_larger ? ib : ia, nullptr, true, 2 * kAsOne},
                                 regions[a_larger ? b : a].pose, regions[a_larger ? a : b].pose) <= kAsOne;
      alike = fits ? static_cast<std::uint8_t>(alike + 1) : std::uint8_t{0};
      if (alike < settings.merge_after) continue;
      alike = 0;
      if (!a_larger) take_motion(regions, a, TrackedRegion(regions[b]));
      dissolve(context, state, regions, points, b, ia);
      return true;
    }
  return false;
}

void count_members(const ModelTables& model, const PointState& points, RegionSet& regions) noexcept {
  for (TrackedRegion& region : regions) region.members = region.facing = 0;
  for (std::size_t i = 0; i < model.size; ++i) {
    TrackedRegion& region = regions[static_cast<std::size_t>(points.home[i])];
    ++region.members;
    region.facing += points.sight[i] != Sight::none ? 1U : 0U;
  }
}

/// Rigid points bear the label of the region that they belong to now, where it puts them: those that changed
/// region, or all of them. Those that are seen elsewhere stay there, as deformed ones.
void settle(const RegroupContext& context, const RegionSet& regions, bool all, PointState& points) noexcept {
  const RegionPoses poses = fixed_poses(regions, context.model.centre);
  const std::int32_t noise =
      context.tolerance.smoothed_noise(depth_of(regions[0].pose, context.model.centre));
  for (std::size_t i = 0; i < context.model.size; ++i) {
    if (points.label[i] < 0 || (!all && points.label[i] == points.home[i])) continue;
    const Sighting::Look look = context.sighting.look(i, poses[static_cast<std::size_t>(points.home[i])]);
    if (look.sight == Sight::agrees) {
      const std::int32_t error =
          model_error(points.misfit[i], noise, context.tolerance.deformed(look.point.z));
      points.label[i] = points.home[i];
      points.position[i] = moved_along(look.point, look.normal, error);
      points.residual[i] = look.residual - error;
      points.match[i] = look.match;
    } else {
      points.label[i] = kDeformed;
    }
  }
}

}  // namespace

bool regroup(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
             RegionSet& regions, PointState& points) noexcept {
  count_members(context.model, points, regions);
  const bool switched = switch_patches(context, state, regions, points);
  bool changed = hand_over_base(context, settings.merge_after, state, regions, points) ||
                 merge(context, settings, state, regions, points);
  if (!changed && split_parts(context, settings, state, regions, points)) {
    changed = true;
    // the larger of what was the base stays the base
    count_members(context.model, points, regions);
    (void)hand_over_base(context, 1, state, regions, points);
  }
  if (switched || changed) settle(context, regions, changed, points);
  return changed;
}

}  // namespace pliant

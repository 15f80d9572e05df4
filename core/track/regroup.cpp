#include "core/track/regroup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/track/compare_poses.hpp"
#include "core/track/hand_over.hpp"
#include "core/track/patch_flood.hpp"

namespace pliant {

namespace {

/// Shares of the inlier limit by which one pose may explain readings worse than two before a region splits,
/// and up to which two regions are one. The limit is 4 σ or more and a reading's mean error after smoothing a
/// third of σ: below a tenth all is noise. The gap between the two keeps a region from coming and going.
constexpr double kAsTwo = 0.22, kAsOne = 0.15;
constexpr int kSwitchAfter = 2;  // frames in which a neighbouring region must suit a patch better

double limit_at(const RegroupContext& context, const RigidTransform& pose) noexcept {
  return context.tolerance.deformed(depth_of(pose, context.model.centre)) / kUnitsPerMetre;
}

/// Points of region `from`, all or those of one patch, become region `to`'s.
void give(const RegroupContext& context, std::int8_t from, std::int8_t to, int patch,
          PointState& points) noexcept {
  for (std::size_t i = 0; i < points.home.size(); ++i) {
    if (points.home[i] != from || (patch >= 0 && context.patches.patch_of[i] != patch)) continue;
    points.home[i] = to;
    points.evidence[i] = 0;
    points.switching[i] = 0;
  }
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == from && (patch < 0 || static_cast<int>(p) == patch))
      context.warp.home[p] = to;
}

bool hangs_on(const RegionSet& regions, std::int8_t k, std::int8_t on) noexcept {
  for (std::size_t step = 0; step < regions.size() && k >= 0; ++step) {
    k = regions[static_cast<std::size_t>(k)].parent;
    if (k == on) return true;
  }
  return false;
}

/// Where a region is: what nobody sees goes with what it hangs on.
RigidTransform place_of(const RegionSet& regions, const TrackedRegion& region) noexcept {
  return region.frames_unseen > 0 && region.parent >= 0
             ? regions[static_cast<std::size_t>(region.parent)].pose * region.from_parent
             : region.pose;
}

/// Hangs region `k` on `parent`, where it is; -1: on nothing.
void hang(RegionSet& regions, std::size_t k, std::int8_t parent) noexcept {
  TrackedRegion& region = regions[k];
  region.pose = place_of(regions, region);
  region.parent = parent;
  if (parent >= 0)
    region.from_parent = regions[static_cast<std::size_t>(parent)].pose.inverse() * region.pose;
}

/// Region `to` takes over how `from` moves; what hangs on it stays where it is.
void take_motion(RegionSet& regions, std::size_t to, const TrackedRegion& from) noexcept {
  std::array<RigidTransform, limits::kMaxRegions> places;
  for (std::size_t r = 0; r < regions.size(); ++r) places[r] = place_of(regions, regions[r]);
  regions[to].pose = from.pose;
  regions[to].last_pose = from.last_pose;
  regions[to].motion = from.motion;
  regions[to].steps = from.steps;
  regions[to].frames_unseen = from.frames_unseen;
  for (std::size_t r = 0; r < regions.size(); ++r)
    if (regions[r].alive && regions[r].parent == static_cast<std::int8_t>(to)) {
      regions[r].pose = places[r];
      regions[r].from_parent = from.pose.inverse() * places[r];
    }
}

void dissolve(const RegroupContext& context, RegroupState& state, RegionSet& regions, PointState& points,
              std::size_t k, std::int8_t into) noexcept {
  const auto id = static_cast<std::int8_t>(k);
  give(context, id, into, -1, points);
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
    give(context, home, best, static_cast<int>(p), points);
    any = true;
  }
  return any;
}

bool adjacent(const RegroupContext& context, std::int8_t a, std::int8_t b) noexcept {
  for (std::size_t k = 0; k < context.patches.border_count; ++k) {
    const std::int8_t x = context.warp.home[context.patches.borders[k].a],
                      y = context.warp.home[context.patches.borders[k].b];
    if ((x == a && y == b) || (x == b && y == a)) return true;
  }
  return false;
}

bool is_seen(const RegroupContext& context, std::int8_t k) noexcept {
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k && patch_counts(context.warp, p)) return true;
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
      const bool fits =
          worse_by(context.model, context.patches, context.sighting, points, {a_larger ? ib : ia, nullptr},
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

std::size_t free_slot(const RegionSet& regions, int max_regions) noexcept {
  std::size_t slot = 1;
  while (slot < static_cast<std::size_t>(max_regions) && regions[slot].alive) ++slot;
  return slot < static_cast<std::size_t>(max_regions) ? slot : 0;
}

/// The part with those patches of region `k` that nobody sees and that lie nearer to it, along the patch
/// graph, than to the rest.
PatchSet complete_part(const RegroupContext& context, std::int8_t k, const PatchSet& part) noexcept {
  PatchSet decided, out = part;
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k && (part.has(p) || context.warp.seen[p] > 0)) decided.add(p);
  (void)flood(context.patches, decided, [&](std::size_t p, std::size_t q) {
    if (context.warp.home[q] != k) return false;
    if (out.has(p)) out.add(q);
    return true;
  });
  return out;
}

/// Points of the seen patches of region `k`, in `part` or outside of it, that one motion carries to within a
/// quarter of the limit: what bends is no rigid part, however large.
std::uint32_t carried(const RegroupContext& context, std::int8_t k, const PatchSet& part, bool inside,
                      const RigidTransform& pose, double limit) noexcept {
  std::uint32_t count = 0;
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k && part.has(p) == inside && patch_counts(context.warp, p) &&
        patch_deviation(context.patches, context.warp, p, pose) < limit * limit / 16)
      count += context.patches.sizes[p];
  return count;
}

/// Makes region `slot` of a part of region `k`. The side of which more is rigid keeps the id.
void split(const RegroupContext& context, std::int8_t k, std::size_t slot, const RigidPart& found,
           RegionSet& regions, PointState& points) noexcept {
  const PatchSet part = complete_part(context, k, found.patches);
  TrackedRegion& old = regions[static_cast<std::size_t>(k)];
  TrackedRegion& fresh = regions[slot];
  fresh = old;
  fresh.parent = k;
  fresh.frames_unseen = 0;
  PatchSet rest;
  const double limit = limit_at(context, old.pose);
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k && !part.has(p) && patch_counts(context.warp, p) &&
        patch_deviation(context.patches, context.warp, p, old.pose) < limit * limit)
      rest.add(p);
  const RigidTransform rest_pose = fit_patches(context.patches, context.warp, rest, old.pose);
  const bool part_stays =
      carried(context, k, part, true, found.pose, limit) > carried(context, k, part, false, rest_pose, limit);
  old.pose = part_stays ? found.pose : rest_pose;
  fresh.pose = part_stays ? rest_pose : found.pose;
  fresh.from_parent = old.pose.inverse() * fresh.pose;  // none of its points bears its label yet
  for (std::size_t i = 0; i < context.model.size; ++i) {
    if (points.home[i] != k) continue;
    const bool in = part.has(context.patches.patch_of[i]);
    if (in != part_stays) points.home[i] = static_cast<std::int8_t>(slot);
    if (!in) continue;
    points.switching[i] = 0;
    points.evidence[i] = 0;
  }
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k && part.has(p) != part_stays)
      context.warp.home[p] = static_cast<std::int8_t>(slot);
}

/// A part of fewer points than this many of the smallest regions shows too little outline: beside a joint,
/// what bends there would become a region of its own.
constexpr std::uint32_t kWithOutline = 2;

std::uint32_t size_of(const PatchTables& patches, const PatchSet& set) noexcept {
  std::uint32_t size = 0;
  for (std::size_t p = 0; p < patches.count; ++p) size += set.has(p) ? patches.sizes[p] : 0;
  return size;
}

/// The region beside a part of region `k` whose motion explains the part as well as its own does: what the
/// part slides along its own surface by is no motion of its own. None: -1.
std::int8_t explained_by(const RegroupContext& context, std::int8_t k, const RigidPart& part, bool outline,
                         const RegionSet& regions, const PointState& points) noexcept {
  std::array<bool, limits::kMaxRegions> beside{};
  for (std::size_t b = 0; b < context.patches.border_count; ++b) {
    const PatchBorder& border = context.patches.borders[b];
    if (part.patches.has(border.a)) beside[static_cast<std::size_t>(context.warp.home[border.b])] = true;
    if (part.patches.has(border.b)) beside[static_cast<std::size_t>(context.warp.home[border.a])] = true;
  }
  std::int8_t best = -1;
  double least = kAsOne;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (!beside[r] || !regions[r].alive || static_cast<std::int8_t>(r) == k) continue;
    const double worse = worse_by(context.model, context.patches, context.sighting, points,
                                  {k, &part.patches, outline}, part.pose, regions[r].pose);
    if (worse > least) continue;
    least = worse;
    best = static_cast<std::int8_t>(r);
  }
  return best;
}

bool split_parts(const RegroupContext& context, const RegroupSettings& settings, std::size_t slot,
                 RegroupState& state, RegionSet& regions, PointState& points) noexcept {
  PartSearchSettings search;
  search.fewest_points = settings.fewest_points;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const TrackedRegion& region = regions[k];
    if (!region.alive || region.members < 2 * settings.fewest_points) continue;
    search.limit = limit_at(context, region.pose);
    const auto id = static_cast<std::int8_t>(k);
    RigidPart part;
    bool outline = false;
    const auto shows_two = [&] {
      if (!find_rigid_part(context.patches, context.warp, id, region.pose, search, part)) return false;
      outline = size_of(context.patches, part.patches) >= kWithOutline * settings.fewest_points;
      return worse_by(context.model, context.patches, context.sighting, points, {id, &part.patches, outline},
                      part.pose, region.pose) >= kAsTwo;
    };
    if (!shows_two()) {
      state.suspected[k] = 0;
    } else if (++state.suspected[k] >= settings.split_after) {
      state.suspected[k] = 0;
      const std::int8_t other = explained_by(context, id, part, outline, regions, points);
      if (other < 0)
        split(context, id, slot, part, regions, points);
      else
        complete_part(context, id, part.patches).for_each([&](std::size_t p) {
          give(context, id, other, static_cast<int>(p), points);
        });
      return true;
    }
  }
  return false;
}

/// Rigid points bear the label of the region that they belong to now, where it puts them: those that changed
/// region, or all of them. Those that are seen elsewhere stay there, as deformed ones.
void settle(const RegroupContext& context, const RegionSet& regions, bool all, PointState& points) noexcept {
  const RegionPoses poses = fixed_poses(regions, context.model.centre);
  for (std::size_t i = 0; i < context.model.size; ++i) {
    if (points.label[i] < 0 || (!all && points.label[i] == points.home[i])) continue;
    const Sighting::Look look = context.sighting.look(i, poses[static_cast<std::size_t>(points.home[i])]);
    if (look.sight == Sight::agrees) {
      points.label[i] = points.home[i];
      points.position[i] = look.point;
    } else {
      points.label[i] = kDeformed;
    }
  }
}

}  // namespace

bool regroup(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
             RegionSet& regions, PointState& points) noexcept {
  for (TrackedRegion& region : regions) region.members = 0;
  for (std::size_t i = 0; i < context.model.size; ++i)
    ++regions[static_cast<std::size_t>(points.home[i])].members;
  const bool switched = switch_patches(context, state, regions, points);
  bool changed = hand_over_base(context, settings, state, regions, points) ||
                 merge(context, settings, state, regions, points);
  if (const std::size_t slot = free_slot(regions, settings.max_regions); slot != 0 && !changed)
    changed = split_parts(context, settings, slot, state, regions, points);
  if (switched || changed) settle(context, regions, changed, points);
  return changed;
}

}  // namespace pliant

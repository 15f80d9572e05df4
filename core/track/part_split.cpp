#include "core/track/part_split.hpp"

#include "core/track/compare_poses.hpp"
#include "core/track/patch_flood.hpp"

namespace pliant {

namespace {

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

}  // namespace

void give_points(const RegroupContext& context, std::int8_t from, std::int8_t to, int patch,
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

double limit_at(const RegroupContext& context, const RigidTransform& pose) noexcept {
  return context.tolerance.deformed(depth_of(pose, context.model.centre)) / kUnitsPerMetre;
}

bool split_parts(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
                 RegionSet& regions, PointState& points) noexcept {
  const std::size_t slot = free_slot(regions, settings.max_regions);
  if (slot == 0) return false;
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
          give_points(context, id, other, static_cast<int>(p), points);
        });
      return true;
    }
  }
  return false;
}

}  // namespace pliant

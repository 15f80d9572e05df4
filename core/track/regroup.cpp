#include "core/track/regroup.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/track/label.hpp"

namespace pliant {

namespace {

constexpr int kSwitchAfter = 2;  // frames in which a neighbouring region must suit a patch better

double limit_at(const RegroupContext& context, const RigidTransform& pose) noexcept {
  const Vector3 where = pose * context.model.centre;
  return context.tolerance.deformed(static_cast<std::int32_t>(where.z() * kUnitsPerMetre)) / kUnitsPerMetre;
}

/// Points of region `from`, all or those of one patch, become region `to`'s.
void give(const RegroupContext& context, std::int8_t from, std::int8_t to, int patch,
          PointState& points) noexcept {
  for (std::size_t i = 0; i < points.home.size(); ++i) {
    if (points.home[i] != from || (patch >= 0 && context.patches.patch_of[i] != patch)) continue;
    points.home[i] = to;
    points.evidence[i] = 0;
    points.switching[i] = 0;
    if (points.label[i] == from) points.label[i] = to;
  }
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == from && (patch < 0 || static_cast<int>(p) == patch))
      context.warp.home[p] = to;
}

void dissolve(const RegroupContext& context, RegionSet& regions, PointState& points, std::size_t k,
              std::int8_t into) noexcept {
  const auto id = static_cast<std::int8_t>(k);
  give(context, id, into, -1, points);
  const std::int8_t parent = regions[k].parent;
  for (std::size_t r = 0; r < regions.size(); ++r)
    if (regions[r].alive && regions[r].parent == id)
      regions[r].parent = static_cast<std::size_t>(into) == r ? parent : into;
  regions[k] = TrackedRegion();
}

/// Patches go over to the neighbouring region whose motion is theirs.
void switch_patches(const RegroupContext& context, RegroupState& state, const RegionSet& regions,
                    PointState& points) noexcept {
  for (std::size_t p = 0; p < context.patches.count; ++p) {
    const std::int8_t home = context.warp.home[p];
    std::int8_t best = home;
    if (patch_counts(context.warp, p)) {
      const double limit = limit_at(context, regions[static_cast<std::size_t>(home)].pose);
      const double own =
          patch_deviation(context.patches, context.warp, p, regions[static_cast<std::size_t>(home)].pose);
      double least = std::min(0.25 * limit * limit, 0.25 * own);
      if (own > 0.1 * limit * limit)
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
  }
}

/// How far two motions part on the patches of region `k`, root mean square, metres.
double parting(const RegroupContext& context, std::int8_t k, const RigidTransform& a,
               const RigidTransform& b) noexcept {
  double sum = 0, weight = 0;
  for (std::size_t p = 0; p < context.patches.count; ++p) {
    if (context.warp.home[p] != k) continue;
    sum += context.patches.sizes[p] *
           (a * context.patches.centres[p] - b * context.patches.centres[p]).squaredNorm();
    weight += context.patches.sizes[p];
  }
  return weight > 0 ? std::sqrt(sum / weight) : 0;
}

bool adjacent(const RegroupContext& context, std::int8_t a, std::int8_t b) noexcept {
  for (std::size_t k = 0; k < context.patches.border_count; ++k) {
    const std::int8_t x = context.warp.home[context.patches.borders[k].a],
                      y = context.warp.home[context.patches.borders[k].b];
    if ((x == a && y == b) || (x == b && y == a)) return true;
  }
  return false;
}

/// Two regions become one when one motion suits both; the lower id stays. A region that lost its points goes,
/// too.
bool merge(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
           RegionSet& regions, PointState& points) noexcept {
  for (std::size_t k = 1; k < regions.size(); ++k)
    if (regions[k].alive && regions[k].members < settings.fewest_points / 2) {
      dissolve(context, regions, points, k, regions[k].parent);
      return true;
    }
  for (std::size_t b = 1; b < regions.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      std::uint8_t& alike = state.alike[a][b];
      const auto ia = static_cast<std::int8_t>(a), ib = static_cast<std::int8_t>(b);
      if (!regions[a].alive || !regions[b].alive || !adjacent(context, ia, ib)) {
        alike = 0;
        continue;
      }
      const bool a_larger = regions[a].members >= regions[b].members;
      const bool fits = parting(context, a_larger ? ib : ia, regions[a].pose, regions[b].pose) <=
                        0.5 * limit_at(context, regions[a].pose);
      alike = fits ? static_cast<std::uint8_t>(alike + 1) : std::uint8_t{0};
      if (alike < settings.merge_after) continue;
      alike = 0;
      if (!a_larger) regions[a].pose = regions[b].pose;
      dissolve(context, regions, points, b, ia);
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
  std::array<std::uint8_t, kMaxPatches> queue{};
  PatchSet reached, out = part;
  std::size_t head = 0, tail = 0;
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k && (part.has(p) || context.warp.seen[p] > 0)) {
      reached.add(p);
      queue[tail++] = static_cast<std::uint8_t>(p);
    }
  while (head < tail) {
    const std::size_t p = queue[head++];
    for (std::size_t q = 0; q < context.patches.count; ++q) {
      if (!context.patches.neighbours[p].has(q) || reached.has(q) || context.warp.home[q] != k) continue;
      reached.add(q);
      if (out.has(p)) out.add(q);
      queue[tail++] = static_cast<std::uint8_t>(q);
    }
  }
  return out;
}

/// Makes region `slot` of a part of region `k`. The larger side keeps the id.
void split(const RegroupContext& context, std::int8_t k, std::size_t slot, const RigidPart& found,
           RegionSet& regions, PointState& points) noexcept {
  const PatchSet part = complete_part(context, k, found.patches);
  std::uint32_t in_part = 0, in_rest = 0;
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k) (part.has(p) ? in_part : in_rest) += context.patches.sizes[p];
  const bool part_stays = in_part > in_rest;
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
  old.pose = part_stays ? found.pose : rest_pose;
  fresh.pose = part_stays ? rest_pose : found.pose;
  const FixedPose poses[2] = {FixedPose(old.pose, context.model.centre),
                              FixedPose(fresh.pose, context.model.centre)};
  for (std::size_t i = 0; i < context.model.size; ++i) {
    if (points.home[i] != k) continue;
    const bool moves = part.has(context.patches.patch_of[i]) != part_stays;
    const bool in = part.has(context.patches.patch_of[i]);
    if (moves) points.home[i] = static_cast<std::int8_t>(slot);
    if (!in) continue;
    points.switching[i] = 0;
    points.evidence[i] = 0;
    if (points.label[i] == kNotObserved) continue;
    points.label[i] = points.home[i];
    points.position[i] =
        poses[moves ? 1 : 0].point(context.model.x[i], context.model.y[i], context.model.z[i]);
    points.offset[i] = {};
  }
  if (part_stays)
    for (std::size_t i = 0; i < context.model.size; ++i)
      if (points.home[i] == static_cast<std::int8_t>(slot) && points.label[i] == k)
        points.label[i] = points.home[i];
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (context.warp.home[p] == k && part.has(p) != part_stays)
      context.warp.home[p] = static_cast<std::int8_t>(slot);
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
    if (!find_rigid_part(context.patches, context.warp, id, region.pose, search, part)) {
      state.suspected[k] = 0;
    } else if (++state.suspected[k] >= settings.split_after) {
      state.suspected[k] = 0;
      split(context, id, slot, part, regions, points);
      return true;
    }
  }
  return false;
}

}  // namespace

Joint joint_of(const ModelTables& model, const PointState& points, std::int8_t region,
               std::int8_t neighbour) noexcept {
  std::int64_t x = 0, y = 0, z = 0;
  Joint joint;
  for (std::size_t i = 0; i < model.size; ++i) {
    if (points.home[i] != region) continue;
    for (const std::uint16_t n : model.model->neighbours(i)) {
      if (n >= model.size || points.home[n] != neighbour) continue;
      x += model.x[i] + model.x[n];
      y += model.y[i] + model.y[n];
      z += model.z[i] + model.z[n];
      ++joint.edges;
    }
  }
  if (joint.edges > 0) {
    const double scale = 0.5 / (joint.edges * kUnitsPerMetre);
    joint.centre = model.centre +
                   Vector3(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)) * scale;
  }
  return joint;
}

bool regroup(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
             RegionSet& regions, PointState& points) noexcept {
  for (TrackedRegion& region : regions) region.members = 0;
  for (std::size_t i = 0; i < context.model.size; ++i)
    ++regions[static_cast<std::size_t>(points.home[i])].members;
  switch_patches(context, state, regions, points);
  const bool merged = merge(context, settings, state, regions, points);
  const std::size_t slot = free_slot(regions, settings.max_regions);
  if (slot == 0 || merged) return merged;
  return split_parts(context, settings, slot, state, regions, points);
}

}  // namespace pliant

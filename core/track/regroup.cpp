#include "core/track/regroup.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/track/label.hpp"
#include "core/track/outlier_split.hpp"

namespace pliant {

namespace {

constexpr int kPauseAfterTry = 3;  // frames; evidence for the next try must build up first

/// Largest distance, 1/16 mm, between where two poses put the points of region `k` (a sample of them).
std::int32_t largest_gap(const ModelTables& model, const RigidTransform& a, const RigidTransform& b,
                         std::int8_t k, const PointState& points) noexcept {
  const FixedPose pose_a(a, model.centre), pose_b(b, model.centre);
  std::int32_t largest = 0;
  for (std::size_t i = 0; i < model.size; ++i) {
    if (points.home[i] != k) continue;
    const IntPoint p = pose_a.point(model.x[i], model.y[i], model.z[i]);
    const IntPoint q = pose_b.point(model.x[i], model.y[i], model.z[i]);
    largest = std::max({largest, std::abs(p.x - q.x), std::abs(p.y - q.y), std::abs(p.z - q.z)});
  }
  return largest;
}

void dissolve(RegionSet& regions, PointState& points, std::size_t k) noexcept {
  const std::int8_t parent = regions[k].parent;
  for (std::size_t i = 0; i < points.home.size(); ++i)
    if (points.home[i] == static_cast<std::int8_t>(k)) {
      points.home[i] = parent;
      points.evidence[i] = 0;
      points.switching[i] = 0;
      if (points.label[i] == static_cast<std::int8_t>(k)) points.label[i] = parent;
    }
  for (TrackedRegion& other : regions)
    if (other.alive && other.parent == static_cast<std::int8_t>(k)) other.parent = parent;
  regions[k] = TrackedRegion();
}

std::int32_t limit_at(const RegroupContext& context, const RigidTransform& pose) noexcept {
  const Vector3 where = pose * context.model.centre;
  return context.tolerance.deformed(static_cast<std::int32_t>(where.z() * kUnitsPerMetre));
}

/// How far two motions part at the centre of the border between regions `k` and `parent`, metres.
double joint_gap(const RegroupContext& context, const RegionSet& regions, std::int8_t k, std::int8_t parent,
                 const PointState& points) noexcept {
  const Joint joint = joint_of(context.model, points, k, parent);
  if (joint.edges == 0) return 0;
  return (regions[static_cast<std::size_t>(k)].pose * joint.centre -
          regions[static_cast<std::size_t>(parent)].pose * joint.centre)
      .norm();
}

bool merge(const RegroupContext& context, const RegroupSettings& settings, RegionSet& regions,
           PointState& points) noexcept {
  bool changed = false;
  for (std::size_t k = 1; k < regions.size(); ++k) {
    TrackedRegion& region = regions[k];
    if (!region.alive || region.parent < 0) continue;
    const auto id = static_cast<std::int8_t>(k);
    const TrackedRegion& parent = regions[static_cast<std::size_t>(region.parent)];
    const std::int32_t limit = limit_at(context, region.pose);
    const bool alike = largest_gap(context.model, region.pose, parent.pose, id, points) <= limit / 2;
    region.frames_alike = alike ? region.frames_alike + 1 : 0;
    const bool vanished = region.members < settings.fewest_points / 2;
    const bool torn = joint_gap(context, regions, id, region.parent, points) > 4 * limit / kUnitsPerMetre;
    if (region.frames_alike < settings.merge_after && !vanished && !torn) continue;
    dissolve(regions, points, k);
    changed = true;
  }
  return changed;
}

std::size_t free_slot(const RegionSet& regions, int max_regions) noexcept {
  std::size_t slot = 1;
  while (slot < static_cast<std::size_t>(max_regions) && regions[slot].alive) ++slot;
  return slot < static_cast<std::size_t>(max_regions) ? slot : 0;
}

/// Patches of region `k` that no reading speaks for go with the side that is nearest in the patch graph.
void complete_part(const RegroupContext& context, std::int8_t k, const PointState& points,
                   MotionSplit& split) noexcept {
  split.members = {};
  for (std::size_t i = 0; i < context.model.size; ++i)
    split.members[context.patches.patch_of[i]] += points.home[i] == k ? 1U : 0U;
  std::array<std::uint8_t, kMaxPatches> queue{};
  PatchSet reached;
  std::size_t head = 0, tail = 0;
  for (std::size_t p = 0; p < context.patches.count; ++p)
    if (split.energy[p].points > 4) {
      reached.add(p);
      queue[tail++] = static_cast<std::uint8_t>(p);
    }
  while (head < tail) {
    const std::size_t p = queue[head++];
    for (std::size_t q = 0; q < context.patches.count; ++q) {
      if (!context.patches.neighbours[p].has(q) || reached.has(q) || split.members[q] == 0) continue;
      reached.add(q);
      if (split.part.has(p)) split.part.add(q);
      queue[tail++] = static_cast<std::uint8_t>(q);
    }
  }
}

/// Makes two regions of region `k`. The larger side keeps the id. Undone when the sides do not stay joined.
bool apply_motion_split(const RegroupContext& context, std::int8_t k, std::size_t slot,
                        const MotionSplitSettings& settings, MotionSplit& split, RegionSet& regions,
                        PointState& points) noexcept {
  complete_part(context, k, points, split);
  std::uint32_t part = 0, rest = 0;
  for (std::size_t p = 0; p < context.patches.count; ++p)
    (split.part.has(p) ? part : rest) += split.members[p];
  const bool part_stays = part > rest;
  TrackedRegion& old = regions[static_cast<std::size_t>(k)];
  const TrackedRegion before = old;
  TrackedRegion& fresh = regions[slot];
  fresh = before;
  fresh.parent = k;
  fresh.frames_alike = fresh.frames_unseen = 0;
  for (std::size_t i = 0; i < context.model.size; ++i) {
    if (points.home[i] != k || split.part.has(context.patches.patch_of[i]) == part_stays) continue;
    points.home[i] = static_cast<std::int8_t>(slot);
  }
  const PatchEnergy& stays = part_stays ? split.part_energy : split.rest_energy;
  const PatchEnergy& leaves = part_stays ? split.rest_energy : split.part_energy;
  const Vector6 old_motion = best_motion(stays, settings.noise, nullptr);
  const Joint joint = joint_of(context.model, points, static_cast<std::int8_t>(slot), k);
  JointSpring spring;
  spring.arm = before.pose * joint.centre - split.centre;
  spring.displacement = Vector3(old_motion.head<3>()).cross(spring.arm) + Vector3(old_motion.tail<3>());
  spring.stiffness = joint_stiffness(joint.edges, settings.noise, context.model);
  const Vector6 new_motion = best_motion(leaves, settings.noise, &spring);
  old.pose = motion_about(old_motion, split.centre) * before.pose;
  fresh.pose = motion_about(new_motion, split.centre) * before.pose;
  const double spread = std::sqrt(std::max(0.0, leaves.at(new_motion) / leaves.points));
  const bool torn = joint_gap(context, regions, static_cast<std::int8_t>(slot), k, points) >
                    limit_at(context, before.pose) / kUnitsPerMetre;
  if (torn || spread > 2.5 * settings.noise) {
    for (std::size_t i = 0; i < context.model.size; ++i)
      if (points.home[i] == static_cast<std::int8_t>(slot)) points.home[i] = k;
    old = before;
    fresh = TrackedRegion();
    return false;
  }
  for (std::size_t i = 0; i < context.model.size; ++i) {
    const std::int8_t home = points.home[i];
    if (home != k && home != static_cast<std::int8_t>(slot)) continue;
    points.switching[i] = 0;
    points.evidence[i] = 0;
    if (points.label[i] == k) points.label[i] = home;
  }
  return true;
}

bool split_by_motion(const RegroupContext& context, const RegroupSettings& settings, std::size_t slot,
                     RegroupState& state, MotionSplit& scratch, RegionSet& regions,
                     PointState& points) noexcept {
  const auto z = static_cast<std::int32_t>((regions[0].pose * context.model.centre).z() * kUnitsPerMetre);
  MotionSplitSettings motion;
  motion.fewest_points = settings.fewest_points;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const TrackedRegion& region = regions[k];
    if (!region.alive || region.members < 2 * settings.fewest_points) continue;
    motion.noise = std::max(region.scale, context.surface.sigma(z) / 2) / kUnitsPerMetre;
    motion.noise = std::min(motion.noise, context.surface.sigma(z) * 1.5 / kUnitsPerMetre);
    motion.moved = 0.5 * limit_at(context, region.pose) / kUnitsPerMetre;
    const auto id = static_cast<std::int8_t>(k);
    int& suspected = state.suspected[k];
    if (!find_motion_split(context.patches, id, motion, points, scratch)) {
      suspected = 0;
    } else if (++suspected >= 2) {
      suspected = 0;
      if (apply_motion_split(context, id, slot, motion, scratch, regions, points)) return true;
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
             MotionSplit& scratch, RegionSet& regions, PointState& points) noexcept {
  for (TrackedRegion& region : regions) region.members = 0;
  for (std::size_t i = 0; i < context.model.size; ++i)
    ++regions[static_cast<std::size_t>(points.home[i])].members;
  bool changed = merge(context, settings, regions, points);
  const std::size_t slot = free_slot(regions, settings.max_regions);
  if (slot == 0) return changed;
  if (split_by_motion(context, settings, slot, state, scratch, regions, points)) return true;
  if (state.pause > 0) {
    --state.pause;
    return changed;
  }
  state.pause = kPauseAfterTry;
  if (!split_outliers(context.model, context.surface, context.projector, context.tolerance,
                      settings.fewest_points, slot, regions, points))
    return changed;
  // an island, or a part that came off, is no region
  const std::int8_t parent = regions[slot].parent;
  if (joint_gap(context, regions, static_cast<std::int8_t>(slot), parent, points) * kUnitsPerMetre >
      limit_at(context, regions[slot].pose)) {
    dissolve(regions, points, slot);
    return changed;
  }
  return true;
}

}  // namespace pliant

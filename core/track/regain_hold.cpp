#include "core/track/regain_hold.hpp"

namespace pliant {

namespace {

/// Of the set, the patches that deviate from the pose by less than the mean.
PatchSet nearer_half(const PatchTables& patches, const PatchWarp& warp, const PatchSet& set,
                     const RigidTransform& pose) noexcept {
  double sum = 0, weight = 0;
  for (std::size_t p = 0; p < patches.count; ++p)
    if (set.has(p)) {
      sum += warp.seen[p] * patch_deviation(patches, warp, p, pose);
      weight += warp.seen[p];
    }
  PatchSet nearer;
  for (std::size_t p = 0; p < patches.count; ++p)
    if (set.has(p) && patch_deviation(patches, warp, p, pose) * weight <= sum) nearer.add(p);
  return nearer;
}

/// The motion that most of the base's patches share: of all, then of those nearer to that, at last of those
/// that stand by it.
RigidTransform common_motion(const PatchTables& patches, const PatchWarp& warp, const RigidTransform& start,
                             double limit) noexcept {
  PatchSet set;
  for (std::size_t p = 0; p < patches.count; ++p)
    if (warp.home[p] == 0 && patch_counts(warp, p)) set.add(p);
  RigidTransform pose = fit_patches(patches, warp, set, start);
  pose = fit_patches(patches, warp, nearer_half(patches, warp, set, pose), pose);
  return fit_patches(patches, warp, hold_of(patches, warp, 0, pose, limit).patches, pose);
}

}  // namespace

void regain_hold(const ModelTables& model, const PatchTables& patches, const PatchWarp& warp,
                 const Tolerance& tolerance, TrackedRegion& base, PointState& points) noexcept {
  const double limit = tolerance.deformed(depth_of(base.pose, model.centre)) / kUnitsPerMetre;
  const Hold hold = hold_of(patches, warp, 0, base.pose, limit);
  if (!hold.lost()) return;
  const RigidTransform pose = common_motion(patches, warp, base.pose, limit);
  const Hold regained = hold_of(patches, warp, 0, pose, limit);
  if (regained.standing <= 2 * hold.standing) return;  // nothing stands by either: there is no hold to regain
  base.pose = pose;
  base.motion = pose * base.last_pose.inverse();
  for (std::size_t i = 0; i < model.size; ++i)
    if (points.home[i] == 0 && regained.patches.has(patches.patch_of[i])) points.evidence[i] = 0;
}

}  // namespace pliant

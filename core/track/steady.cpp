#include "core/track/steady.hpp"

#include <algorithm>

#include "core/track/model_tables.hpp"

namespace pliant {

namespace {

/// Weight of the latest step in the mean: noise of single steps leaves a quarter of itself in it.
constexpr double kLatest = 1.0 / 8;

/// Below this share of the noise, the mean tells no motion.
constexpr double kNoMotion = 0.5;
/// A sensor's readings wander in step, all of a surface together, by as much as the noise that is left in
/// them.
constexpr double kAtRest = 2;

double share_of_motion(double squared, double noise) noexcept {
  return squared > 0 ? squared / (squared + noise * noise) : 0;
}

}  // namespace

RigidTransform steadied(const RigidTransform& before, const RigidTransform& after, const Vector3& centre,
                        double half_radius, double noise, StepMemory& memory, double least) noexcept {
  const Vector3 at = before * centre;
  const Vector6 x = motion_between(after, before, at);
  Vector6 step = x;
  step.head<3>() *= half_radius;
  memory.mean += kLatest * (step - memory.mean);
  const bool moves = memory.mean.squaredNorm() >= kNoMotion * kNoMotion * noise * noise;
  memory.still = moves ? 0 : std::min(memory.still + 1, kUntilAtRest);
  const double held = memory.still == kUntilAtRest ? kAtRest * noise : noise;
  const double share = std::max({share_of_motion(step.squaredNorm(), 3 * held),
                                 share_of_motion(memory.mean.squaredNorm(), held), least});
  RigidTransform out = motion_about(share * x, at) * before;
  out.rotation = orthonormalised(out.rotation);
  return out;
}

void hold_steady(const ModelTables& model, const Surface& surface, std::int32_t frames,
                 RegionSet& regions) noexcept {
  const double half_radius = 0.5 * model.model->radius();
  for (TrackedRegion& region : regions) {
    if (!region.alive) continue;
    const double depth = (region.last_pose * model.centre).z() * kUnitsPerMetre;
    const std::int32_t spread =
        spread_of_readings(surface.sigma(static_cast<std::int32_t>(depth)), region.scale);
    const double noise = kNoiseOfPose * spread / kUnitsPerMetre;
    region.pose = steadied(region.last_pose, region.pose, model.centre, half_radius, noise, region.steps,
                           least_share(frames));
  }
}

}  // namespace pliant

#include "core/track/steady.hpp"

#include <algorithm>

namespace pliant {

RigidTransform steadied(const RigidTransform& before, const RigidTransform& after, const Vector3& centre,
                        double half_radius, double noise, double least) noexcept {
  const Vector3 at = before * centre;
  const RigidTransform step = after * before.inverse();
  const Vector3 turn = small_vector_from_rotation(step.rotation);
  const Vector3 shift = step * at - at;
  const double squared = shift.squaredNorm() + turn.squaredNorm() * half_radius * half_radius;
  const double share = std::max(squared > 0 ? squared / (squared + noise * noise) : 0, least);
  RigidTransform part;
  part.rotation = rotation_from_small_vector(share * turn);
  part.translation = at + share * shift - part.rotation * at;
  RigidTransform out = part * before;
  out.rotation = orthonormalised(out.rotation);
  return out;
}

void hold_steady(const ModelTables& model, const Surface& surface, std::int32_t frames,
                 RegionSet& regions) noexcept {
  const double half_radius = 0.5 * model.model->radius();
  for (TrackedRegion& region : regions) {
    if (!region.alive) continue;
    const double depth = (region.last_pose * model.centre).z() * kUnitsPerMetre;
    const double noise = kNoiseOfPose * surface.sigma(static_cast<std::int32_t>(depth)) / kUnitsPerMetre;
    region.pose =
        steadied(region.last_pose, region.pose, model.centre, half_radius, noise, least_share(frames));
  }
}

}  // namespace pliant

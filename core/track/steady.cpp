#include "core/track/steady.hpp"

namespace pliant {

void hold_steady(const ModelTables& model, const Surface& surface, RegionSet& regions) noexcept {
  const double half_radius = 0.5 * model.model->radius();
  for (TrackedRegion& region : regions) {
    if (!region.alive) continue;
    const Vector3 before = region.last_pose * model.centre;
    const RigidTransform step = region.pose * region.last_pose.inverse();
    const Vector3 turn = small_vector_from_rotation(step.rotation);
    const Vector3 shift = step * before - before;
    const double squared = shift.squaredNorm() + turn.squaredNorm() * half_radius * half_radius;
    const double noise =
        0.5 * surface.sigma(static_cast<std::int32_t>(before.z() * kUnitsPerMetre)) / kUnitsPerMetre;
    const double share = squared / (squared + noise * noise);
    RigidTransform part;
    part.rotation = rotation_from_small_vector(share * turn);
    part.translation = before + share * shift - part.rotation * before;
    region.pose = part * region.last_pose;
    region.pose.rotation = orthonormalised(region.pose.rotation);
  }
}

}  // namespace pliant

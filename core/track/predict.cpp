#include "core/track/predict.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/track/associate.hpp"

namespace pliant {

namespace {

RigidTransform damped(const RigidTransform& motion, const Vector3& centre) noexcept {
  RigidTransform out;
  out.rotation = rotation_from_small_vector(kMotionKept * small_vector_from_rotation(motion.rotation));
  const Vector3 moved = centre + kMotionKept * (motion * centre - centre);
  out.translation = moved - out.rotation * centre;
  return out;
}

}  // namespace

void predict(RegionSet& regions) noexcept {
  for (TrackedRegion& region : regions) {
    if (!region.alive) continue;
    region.last_pose = region.pose;
    const TrackedRegion* parent =
        region.parent >= 0 ? &regions[static_cast<std::size_t>(region.parent)] : nullptr;
    // about the region's origin: what the motion of its frame is there
    region.predicted = region.frames_unseen > 0 && parent != nullptr && parent->alive
                           ? region.pose
                           : damped(region.motion, region.pose.translation) * region.pose;
  }
  for (TrackedRegion& region : regions) {
    if (!region.alive) continue;
    if (region.frames_unseen > 0 && region.parent >= 0 &&
        regions[static_cast<std::size_t>(region.parent)].alive)
      region.predicted = regions[static_cast<std::size_t>(region.parent)].predicted * region.from_parent;
    region.pose = region.predicted;
  }
}

void choose_still_or_moving(const ModelTables& model, const Surface& surface, const Projector& projector,
                            const PointState& points, std::size_t sample, RegionSet& regions) noexcept {
  struct Hypothesis {
    FixedPose moving, still;
    std::int64_t moving_cost = 0, still_cost = 0;
  };
  std::array<Hypothesis, limits::kMaxRegions> hypotheses;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].alive) continue;
    hypotheses[k].moving = FixedPose(regions[k].predicted, model.centre);
    hypotheses[k].still = FixedPose(regions[k].last_pose, model.centre);
  }
  const std::size_t size = std::min(sample, model.size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto k = static_cast<std::size_t>(points.home[i]);
    if (points.sight[i] != Sight::agrees) continue;  // of the last frame
    Hypothesis& h = hypotheses[k];
    const auto cost = [&](const FixedPose& pose) -> std::int32_t {
      const IntPoint p = pose.point(model.x[i], model.y[i], model.z[i]);
      int u = 0, v = 0;
      const std::int32_t worst = 4 * surface.sigma(p.z);
      if (!projector.project(p, u, v)) return worst;
      const std::uint16_t z8 = surface.depth(u, v);
      return z8 == 0 ? worst : std::min(std::abs(2 * z8 - p.z), worst);
    };
    h.moving_cost += cost(h.moving);
    h.still_cost += cost(h.still);
  }
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].alive || hypotheses[k].still_cost >= hypotheses[k].moving_cost) continue;
    regions[k].predicted = regions[k].last_pose;
    regions[k].pose = regions[k].predicted;
  }
}

Window predicted_window(const ModelTables& model, const Projector& projector, const PointState& points,
                        const RegionSet& regions, std::int32_t reach, int width, int height) noexcept {
  const RegionPoses poses = fixed_poses(regions, model.centre);
  constexpr std::size_t kSample = 512;  // farthest-point order: these reach every end of the object
  Window window{width, height, 0, 0};
  const std::size_t size = std::min(kSample, model.size);
  for (std::size_t i = 0; i < size; ++i) {
    IntPoint p = poses[static_cast<std::size_t>(points.home[i])].point(model.x[i], model.y[i], model.z[i]);
    p = {p.x + points.offset[i].x, p.y + points.offset[i].y, p.z + points.offset[i].z};
    if (p.z < 100 * kUnitsPerMillimetre) continue;
    int u = 0, v = 0;
    if (!projector.project(p, u, v)) continue;
    const int room = projector.pixels(reach, p.z);
    window.u0 = std::min(window.u0, u - room);
    window.v0 = std::min(window.v0, v - room);
    window.u1 = std::max(window.u1, u + room + 1);
    window.v1 = std::max(window.v1, v + room + 1);
  }
  if (window.empty()) return {};
  return {std::max(window.u0, 0), std::max(window.v0, 0), std::min(window.u1, width),
          std::min(window.v1, height)};
}

}  // namespace pliant

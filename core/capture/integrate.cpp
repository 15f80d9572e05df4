#include "core/capture/integrate.hpp"

#include <algorithm>

namespace pliant {

namespace {

constexpr int kMarkStep = 4;  // pixels; less than a block at any distance

/// Activates the blocks around the picture's readings of the object.
void activate_blocks(const ViewPicture& picture, const FixedPose& model_from_camera, const Surface& rays,
                     DistanceVolume& volume) noexcept {
  const Window& w = picture.window;
  for (int v = w.v0; v < w.v1; v += kMarkStep)
    for (int u = w.u0; u < w.u1; u += kMarkStep) {
      const std::size_t i = picture.index(u, v);
      if (picture.facing[i] == 0) continue;
      const IntPoint p = rays.vertex(u, v, picture.depth[i]);
      const IntPoint m = model_from_camera.point(p.x, p.y, p.z);
      if (volume.holds(m)) volume.activate_around(m);
    }
}

/// Weight of a reading by how straight it is seen: 2 at the flattest that is taken, 16 straight on.
std::int32_t weight_of(std::int32_t facing) noexcept {
  const std::int32_t least = facing < 128 ? facing : 128;
  return 1 + ((least * least * 15) >> 14);
}

struct Walk {
  const ViewPicture& picture;
  const Projector& projector;
  const VolumePlan& plan;
};

/// The integer kernel: one row of a block, from camera-frame position `q` (Q14 of 1/16 mm) in steps of
/// `step`.
[[gnu::noinline]] void fuse_row(const Walk& walk, std::int32_t (&q)[3], const std::int32_t (&step)[3],
                                Voxel* voxels) noexcept {
  const Window& w = walk.picture.window;
  const std::int32_t front = walk.plan.front, back = walk.plan.back;
  for (int k = 0; k < kBlock; ++k, q[0] += step[0], q[1] += step[1], q[2] += step[2]) {
    const IntPoint p{q[0] >> 14, q[1] >> 14, q[2] >> 14};
    int u = 0, v = 0;
    if (!walk.projector.project(p, u, v) || !w.contains(u, v)) continue;
    const std::size_t i = walk.picture.index(u, v);
    const std::int32_t depth = 2 * walk.picture.depth[i];
    if (depth == 0) continue;
    const std::int32_t along = depth - p.z, facing = walk.picture.facing[i];
    std::int32_t distance = front, weight = 1;
    if (facing == 0) {
      if (along < 2 * front) continue;  // what is not the object's tells only that space before it is free
    } else {
      const std::int32_t off = std::clamp(along, -4 * back, 4 * front) * facing;  // Q7
      if (off < -(back << 7)) continue;
      if (off < front << 7) {
        distance = off >> 7;
        weight = weight_of(facing);
      }
    }
    Voxel& voxel = voxels[k];
    const std::int32_t before = voxel.weight, sum = before + weight;
    const std::int32_t change = (distance * kDistanceUnits - voxel.distance) * weight;
    voxel.distance =
        static_cast<std::int16_t>(voxel.distance + (change + (change < 0 ? -sum : sum) / 2) / sum);
    voxel.weight = static_cast<std::uint16_t>(std::min(sum, kMostWeight));
  }
}

}  // namespace

void integrate(const ViewPicture& picture, const Projector& projector, const FixedPose& pose,
               const FixedPose& model_from_camera, const Surface& rays, DistanceVolume& volume) noexcept {
  activate_blocks(picture, model_from_camera, rays, volume);
  const VolumePlan& plan = volume.plan();
  const Walk walk{picture, projector, plan};
  const int blocks = plan.blocks();
  const std::int32_t span = plan.voxel * kBlock, half = plan.half();
  const std::int32_t through = span * 7 / 8 + plan.front;  // half of a block's diagonal and the reach
  const std::int32_t step[3] = {pose.r[0] * plan.voxel, pose.r[3] * plan.voxel, pose.r[6] * plan.voxel};
  int block = 0;
  for (int z = 0; z < blocks; ++z)
    for (int y = 0; y < blocks; ++y)
      for (int x = 0; x < blocks; ++x, ++block) {
        const std::int32_t corner[3] = {x * span - half, y * span - half, z * span - half};
        const std::int32_t middle = (span - plan.voxel) / 2;
        const IntPoint centre = pose.point(corner[0] + middle, corner[1] + middle, corner[2] + middle);
        if (!volume.active(block)) {
          int u = 0, v = 0;
          if (!projector.project(centre, u, v) || !picture.window.contains(u, v)) continue;
          if (2 * picture.depth[picture.index(u, v)] - centre.z > through) volume.saw_through(block);
          continue;
        }
        if (centre.z < span) continue;
        for (int dz = 0; dz < kBlock; ++dz)
          for (int dy = 0; dy < kBlock; ++dy) {
            const std::int32_t m[3] = {corner[0], corner[1] + dy * plan.voxel, corner[2] + dz * plan.voxel};
            std::int32_t q[3];
            for (int k = 0; k < 3; ++k)
              q[k] = pose.r[3 * k] * m[0] + pose.r[3 * k + 1] * m[1] + pose.r[3 * k + 2] * m[2] +
                     (pose.t[k] << 14) + 8192;
            fuse_row(walk, q, step, volume.row(x * kBlock, y * kBlock + dy, z * kBlock + dz));
          }
      }
}

}  // namespace pliant

#include "core/capture/integrate.hpp"

#include <algorithm>

#include "core/memory/row_major.hpp"

namespace pliant {

namespace {

constexpr int kMarkStep = 4;                    // pixels; less than a block at any distance
constexpr int kFreeEvery = 4, kOftenEvery = 3;  // see ViewToFuse::one_of_many
constexpr int kTileShift = 3;                   // a tile's edge is 2^3 pixels

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

/// What the rows of one block have in common.
struct Walk {
  const ViewPicture& picture;
  const Projector& projector;
  std::int32_t front, back, free_weight;
  std::int32_t step[3];  // from node to node, camera frame, Q14 of 1/16 mm
};

IntPoint whole(const std::int32_t (&q)[3]) noexcept {
  return {q[0] >> 14, q[1] >> 14, q[2] >> 14};
}

/// The integer kernel: one row of a block, from camera-frame position `q` (Q14 of 1/16 mm). Pixels are found
/// at the row's ends and follow in equal steps between, which perspective bends by less than 1/20 pixel.
[[gnu::noinline]] void fuse_row(const Walk& walk, const std::int32_t (&q)[3], Voxel* voxels) noexcept {
  const std::int32_t end[3] = {q[0] + kBlock * walk.step[0], q[1] + kBlock * walk.step[1],
                               q[2] + kBlock * walk.step[2]};
  std::int32_t u = 0, v = 0, u_end = 0, v_end = 0;
  if (!walk.projector.project_finely(whole(q), u, v) ||
      !walk.projector.project_finely(whole(end), u_end, v_end))
    return;
  const std::int32_t du = (u_end - u) / kBlock, dv = (v_end - v) / kBlock;
  const Window& w = walk.picture.window;
  const std::int32_t front = walk.front, back = walk.back;
  std::int32_t z = q[2];
  for (int k = 0; k < kBlock; ++k, u += du, v += dv, z += walk.step[2]) {
    if (!w.contains(u >> 8, v >> 8)) continue;
    const std::size_t i = walk.picture.index(u >> 8, v >> 8);
    const std::int32_t depth = 2 * walk.picture.depth[i];
    if (depth == 0) continue;
    const std::int32_t along = depth - (z >> 14), facing = walk.picture.facing[i];
    std::int32_t distance = front, weight = walk.free_weight;
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
    voxel.weight = static_cast<std::uint16_t>(std::min(sum, ViewFuser::kMostWeight));
  }
}

}  // namespace

void ViewFuser::lay_out(Workspace& workspace, const Intrinsics& camera) noexcept {
  across_ = (camera.width >> kTileShift) + 1;
  tiles_ = workspace.take<Tile>(static_cast<std::size_t>(across_) *
                                static_cast<std::size_t>((camera.height >> kTileShift) + 1));
}

void ViewFuser::summarise(const ViewPicture& picture) noexcept {
  constexpr std::int32_t kFar = 1 << 20;
  std::fill(tiles_.begin(), tiles_.end(), Tile{kFar, 0, false});
  const Window& w = picture.window;
  for (int v = w.v0; v < w.v1; ++v) {
    Tile* const row = tiles_.data() + static_cast<std::ptrdiff_t>(v >> kTileShift) * across_;
    std::size_t i = picture.index(w.u0, v);
    for (int u = w.u0; u < w.u1; ++u, ++i) {
      const std::int32_t depth = 2 * picture.depth[i];
      if (depth == 0) continue;
      Tile& tile = row[u >> kTileShift];
      tile.nearest = std::min(tile.nearest, depth);
      tile.farthest = std::max(tile.farthest, depth);
      tile.object = tile.object || picture.facing[i] != 0;
    }
  }
}

ViewFuser::Sight ViewFuser::look(const ViewPicture& picture, const IntPoint& centre, std::int32_t radius,
                                 const VolumePlan& plan) const noexcept {
  if (centre.z <= 2 * radius) return Sight::skip;
  std::int32_t u = 0, v = 0;
  if (!projector_->project_finely(centre, u, v)) return Sight::skip;
  const int reach = projector_->pixels(radius, centre.z - radius) + 1;
  const Window& w = picture.window;
  const int u0 = std::max((u >> 8) - reach, w.u0), u1 = std::min((u >> 8) + reach, w.u1 - 1);
  const int v0 = std::max((v >> 8) - reach, w.v0), v1 = std::min((v >> 8) + reach, w.v1 - 1);
  if (u0 > u1 || v0 > v1) return Sight::skip;
  std::int32_t nearest = 1 << 20, farthest = 0;
  bool object = false;
  for (int y = v0 >> kTileShift; y <= v1 >> kTileShift; ++y)
    for (int x = u0 >> kTileShift; x <= u1 >> kTileShift; ++x) {
      const Tile& tile = tiles_[row_major(y, across_, x)];
      nearest = std::min(nearest, tile.nearest);
      farthest = std::max(farthest, tile.farthest);
      object = object || tile.object;
    }
  // A distance along the normal is at least kLeastFacingView / 128 of the one along the axis.
  const std::int32_t back = plan.back * 128 / kLeastFacingView, front = plan.front * 128 / kLeastFacingView;
  if (farthest < centre.z - radius - back) return Sight::skip;  // hidden, or no reading
  if (!object && farthest - (centre.z - radius) < 2 * plan.front) return Sight::skip;
  return nearest - (centre.z + radius) > front ? Sight::free : Sight::fuse;
}

void ViewFuser::fuse(const ViewToFuse& view, const Surface& rays, DistanceVolume& volume) noexcept {
  const FixedPose pose(view.pose, Vector3::Zero());
  activate_blocks(view.picture, FixedPose(view.pose.inverse(), Vector3::Zero()), rays, volume);
  summarise(view.picture);
  ++views_;
  const VolumePlan& plan = volume.plan();
  Walk walk{
      view.picture, *projector_, plan.front,
      plan.back,    1,           {pose.r[0] * plan.voxel, pose.r[3] * plan.voxel, pose.r[6] * plan.voxel}};
  const int blocks = plan.blocks();
  const std::int32_t span = plan.voxel * kBlock, half = plan.half(), middle = (span - plan.voxel) / 2;
  const std::int32_t radius = span * 7 / 8;  // of the ball around a block, half of its diagonal
  int block = 0;
  for (int z = 0; z < blocks; ++z)
    for (int y = 0; y < blocks; ++y)
      for (int x = 0; x < blocks; ++x, ++block) {
        const std::int32_t corner[3] = {x * span - half, y * span - half, z * span - half};
        const IntPoint centre = pose.point(corner[0] + middle, corner[1] + middle, corner[2] + middle);
        if (!volume.active(block)) {
          int u = 0, v = 0;
          if (!projector_->project(centre, u, v) || !view.picture.window.contains(u, v)) continue;
          if (2 * view.picture.depth[view.picture.index(u, v)] - centre.z > radius + plan.front &&
              look(view.picture, centre, radius, plan) == Sight::free)
            volume.saw_through(block);
          continue;
        }
        const Sight sight = look(view.picture, centre, radius, plan);
        if (sight == Sight::skip) continue;
        walk.free_weight = 1;
        if (sight == Sight::free) {
          if (view.one_of_many && (block + views_) % kFreeEvery != 0) continue;
          if (view.one_of_many) walk.free_weight = kFreeEvery;
        } else {
          if (view.one_of_many && volume.fused_often(block) && (block + views_) % kOftenEvery != 0) continue;
          volume.count_fusion(block);
        }
        for (int dz = 0; dz < kBlock; ++dz)
          for (int dy = 0; dy < kBlock; ++dy) {
            const std::int32_t m[3] = {corner[0], corner[1] + dy * plan.voxel, corner[2] + dz * plan.voxel};
            std::int32_t q[3];
            for (std::size_t k = 0; k < 3; ++k)
              q[k] = pose.r[3 * k] * m[0] + pose.r[3 * k + 1] * m[1] + pose.r[3 * k + 2] * m[2] +
                     (pose.t[k] << 14) + 8192;
            fuse_row(walk, q, volume.row(x * kBlock, y * kBlock + dy, z * kBlock + dz));
          }
      }
}

}  // namespace pliant

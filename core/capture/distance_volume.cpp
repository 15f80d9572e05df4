#include "core/capture/distance_volume.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/fixed/integer_root.hpp"

namespace pliant {

void DistanceVolume::lay_out(Workspace& workspace, const VolumePlan& plan) noexcept {
  plan_ = plan;
  per_unit_ = (std::int64_t{1} << 24) / plan.voxel;
  voxels_ = workspace.take<Voxel>(plan.nodes());
  const auto blocks = static_cast<std::size_t>(plan.blocks());
  active_ = workspace.take<std::uint8_t>(blocks * blocks * blocks);
  free_ = workspace.take<std::uint8_t>(blocks * blocks * blocks);
}

void DistanceVolume::clear() noexcept {
  std::fill(voxels_.begin(), voxels_.end(), Voxel{});
  std::fill(active_.begin(), active_.end(), std::uint8_t{0});
  std::fill(free_.begin(), free_.end(), std::uint8_t{0});
}

void DistanceVolume::activate(int block) noexcept {
  std::uint8_t& active = active_[static_cast<std::size_t>(block)];
  if (active != 0) return;
  active = 1;
  const int blocks = plan_.blocks();
  const int x0 = block % blocks * kBlock, y0 = block / blocks % blocks * kBlock,
            z0 = block / blocks / blocks * kBlock;
  // What the camera saw through stays free: a hand that comes into it is told from new surface.
  const std::uint8_t looks = free_[static_cast<std::size_t>(block)];
  if (looks < kFreeLooks) return;
  const Voxel seen{static_cast<std::int16_t>(plan_.front * kDistanceUnits), looks};
  for (int z = z0; z < z0 + kBlock; ++z)
    for (int y = y0; y < y0 + kBlock; ++y) std::fill_n(row(x0, y, z), kBlock, seen);
}

void DistanceVolume::activate_around(const IntPoint& p) noexcept {
  const std::int32_t reach = plan_.front, half = plan_.half(), span = plan_.voxel * kBlock;
  const int most = plan_.blocks() - 1;
  const auto first = [&](std::int32_t x) { return std::max(0, (x + half - reach) / span); };
  const auto last = [&](std::int32_t x) { return std::min(most, (x + half + reach) / span); };
  for (int z = first(p.z); z <= last(p.z); ++z)
    for (int y = first(p.y); y <= last(p.y); ++y)
      for (int x = first(p.x); x <= last(p.x); ++x) activate((z * (most + 1) + y) * (most + 1) + x);
}

Place DistanceVolume::place(const IntPoint& p, std::int32_t& distance) const noexcept {
  const std::size_t block = block_of(p);
  if (active_[block] == 0) return free_[block] >= kFreeLooks ? Place::free : Place::unknown;
  const Voxel& voxel = at(node(p.x), node(p.y), node(p.z));
  if (voxel.weight == 0) return Place::unknown;
  if (voxel.distance >= plan_.front * kDistanceUnits - kDistanceUnits) return Place::free;
  distance = voxel.distance;
  return Place::surface;
}

bool DistanceVolume::stands_in_free_space(const IntPoint& p,
                                          const FixedPose& model_from_camera) const noexcept {
  const std::int32_t deeper = 3 * plan_.voxel;
  if (p.z <= 0) return false;
  const IntPoint m =
      model_from_camera.point(p.x + p.x * deeper / p.z, p.y + p.y * deeper / p.z, p.z + deeper);
  std::int32_t distance = 0;
  if (!holds(m)) return false;
  const Place there = place(m, distance);
  return there == Place::free || (there == Place::surface && distance > 2 * plan_.voxel * kDistanceUnits);
}

bool DistanceVolume::sample(const IntPoint& p, std::int32_t& distance, IntPoint& gradient) const noexcept {
  const std::int32_t half = plan_.half();
  // Node coordinates in Q8.
  const auto scaled = [&](std::int32_t x) {
    return static_cast<std::int32_t>(((x + half) * per_unit_) >> 16);
  };
  const std::int32_t x = scaled(p.x), y = scaled(p.y), z = scaled(p.z);
  const std::int32_t fx = x & 255, fy = y & 255, fz = z & 255;
  const Voxel* const base = &voxels_[index(x >> 8, y >> 8, z >> 8)];
  const std::ptrdiff_t up = plan_.cells, deep = static_cast<std::ptrdiff_t>(plan_.cells) * plan_.cells;
  const std::int32_t limit = plan_.front * kDistanceUnits - kDistanceUnits;
  std::int32_t d[8];
  for (int corner = 0; corner < 8; ++corner) {
    const Voxel& v = base[(corner & 1) + (corner & 2 ? up : 0) + (corner & 4 ? deep : 0)];
    if (v.weight == 0 || v.distance >= limit) return false;
    d[corner] = v.distance;
  }
  // Along x first, then y, then z. Distances are below 2^15, differences below 2^16, fractions below 2^8.
  const auto mix = [](std::int32_t a, std::int32_t b, std::int32_t f) {
    return a + (((b - a) * f + 128) >> 8);
  };
  const std::int32_t x00 = mix(d[0], d[1], fx), x10 = mix(d[2], d[3], fx), x01 = mix(d[4], d[5], fx),
                     x11 = mix(d[6], d[7], fx);
  const std::int32_t xy0 = mix(x00, x10, fy), xy1 = mix(x01, x11, fy);
  distance = mix(xy0, xy1, fz);
  std::int32_t gx = mix(mix(d[1] - d[0], d[3] - d[2], fy), mix(d[5] - d[4], d[7] - d[6], fy), fz);
  std::int32_t gy = mix(x10 - x00, x11 - x01, fz);
  std::int32_t gz = xy1 - xy0;
  // Within 2^14, so that the squares' sum stays below 2^30.
  const std::int32_t largest = std::abs(gx) | std::abs(gy) | std::abs(gz);
  const int shift = largest >> 14 != 0 ? 2 : 0;
  gx >>= shift;
  gy >>= shift;
  gz >>= shift;
  const auto norm =
      static_cast<std::int32_t>(integer_sqrt(static_cast<std::uint32_t>(gx * gx + gy * gy + gz * gz)));
  if (norm == 0) return false;
  gradient = {gx * 16384 / norm, gy * 16384 / norm, gz * 16384 / norm};
  return true;
}

}  // namespace pliant

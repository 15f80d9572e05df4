#include "core/capture/surface_points.hpp"

#include <cstdlib>

namespace pliant {

namespace {

/// Spreads neighbouring nodes over all of [0, 2^16).
std::uint32_t scattered(int x, int y, int z) noexcept {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^
                    static_cast<std::uint32_t>(y) * 0x85EBCA77U ^ static_cast<std::uint32_t>(z) * 0xC2B2AE3DU;
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  return (h ^ (h >> 13)) >> 16;
}

/// Calls visit(x, y, z, voxel) for the nodes next to the surface, but for those at the cube's rim.
template <typename Visit>
void for_nodes_at_surface(const DistanceVolume& volume, int least_weight, Visit&& visit) noexcept {
  const VolumePlan& plan = volume.plan();
  const std::int32_t near = plan.voxel * kDistanceUnits / 2;
  const int blocks = plan.blocks(), last = plan.cells - 2;
  int block = 0;
  for (int bz = 0; bz < blocks; ++bz)
    for (int by = 0; by < blocks; ++by)
      for (int bx = 0; bx < blocks; ++bx, ++block) {
        if (!volume.active(block)) continue;
        for (int z = bz * kBlock; z < (bz + 1) * kBlock; ++z)
          for (int y = by * kBlock; y < (by + 1) * kBlock; ++y)
            for (int x = bx * kBlock; x < (bx + 1) * kBlock; ++x) {
              const Voxel& voxel = volume.at(x, y, z);
              if (voxel.weight < least_weight || std::abs(voxel.distance) > near) continue;
              if (x > 0 && y > 0 && z > 0 && x < last && y < last && z < last) visit(x, y, z, voxel);
            }
      }
}

}  // namespace

std::size_t surface_points(const DistanceVolume& volume, int least_weight, std::span<Point3f> points,
                           std::span<Normal16> normals) noexcept {
  std::size_t all = 0;
  for_nodes_at_surface(volume, least_weight, [&](int, int, int, const Voxel&) { ++all; });
  if (all == 0) return 0;
  // A little less than there is room for: what is scattered varies.
  const std::uint64_t share = points.size() >= all ? 65536 : points.size() * 60000 / all;
  const VolumePlan& plan = volume.plan();
  const std::int32_t half = plan.half();
  std::size_t count = 0;
  for_nodes_at_surface(volume, least_weight, [&](int x, int y, int z, const Voxel& voxel) {
    if (count == points.size() || scattered(x, y, z) >= share) return;
    const IntPoint node{x * plan.voxel - half, y * plan.voxel - half, z * plan.voxel - half};
    std::int32_t distance = 0;
    IntPoint n;
    if (!volume.sample(node, distance, n)) return;
    const double off = voxel.distance / static_cast<double>(kDistanceUnits) / 16384.0;
    const auto at = [&](std::int32_t whole, std::int32_t direction) {
      return static_cast<float>((whole - off * direction) / kUnitsPerMetre);
    };
    points[count] = {at(node.x, n.x), at(node.y, n.y), at(node.z, n.z)};
    normals[count++] = {static_cast<std::int16_t>(n.x), static_cast<std::int16_t>(n.y),
                        static_cast<std::int16_t>(n.z), 0};
  });
  return count;
}

}  // namespace pliant

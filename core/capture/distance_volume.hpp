// A cube of space in which each node knows how far it is from the surface: the truncated signed distance of
// Curless and Levoy (A volumetric method for building complex models from range images, SIGGRAPH 1996), in
// integers.
#pragma once

#include <cstdint>
#include <span>

#include "core/camera/surface.hpp"
#include "core/capture/capture_settings.hpp"
#include "core/memory/row_major.hpp"
#include "core/memory/workspace.hpp"
#include "core/track/model_tables.hpp"

namespace pliant {

/// A node of the grid.
struct Voxel {
  std::int16_t distance = 0;  ///< 1/256 mm, positive before the surface, within the plan's front and back
  std::uint16_t weight = 0;   ///< 0: never seen
};

/// Of a whole number of 1/16 mm.
inline constexpr std::int32_t kDistanceUnits = 16;

/// What the volume knows of a place.
enum class Place : std::uint8_t {
  unknown,  ///< never seen
  surface,  ///< a surface is near
  free      ///< the camera saw through it
};

/// Model frame: origin in the middle of the cube, 1/16 mm. Memory: four bytes a node and two a block.
class DistanceVolume {
 public:
  void lay_out(Workspace& workspace, const VolumePlan& plan) noexcept;
  /// Forgets everything.
  void clear() noexcept;

  [[nodiscard]] const VolumePlan& plan() const noexcept { return plan_; }
  [[nodiscard]] const Voxel& at(int x, int y, int z) const noexcept { return voxels_[index(x, y, z)]; }
  [[nodiscard]] Voxel* row(int x, int y, int z) noexcept { return &voxels_[index(x, y, z)]; }

  /// Does the cube hold the point, with one voxel to spare on each side?
  [[nodiscard]] bool holds(const IntPoint& p) const noexcept {
    const std::int32_t most = plan_.half() - plan_.voxel;
    return p.x >= -most && p.x <= most && p.y >= -most && p.y <= most && p.z >= -most && p.z <= most;
  }
  /// Did a surface come near a point that the cube holds?
  [[nodiscard]] bool near_surface(const IntPoint& p) const noexcept { return active_[block_of(p)] != 0; }
  /// Of the node nearest to a point that the cube holds. `distance` (1/256 mm) is set for Place::surface.
  [[nodiscard]] Place place(const IntPoint& p, std::int32_t& distance) const noexcept;

  /// Does a reading at `p` (camera frame) stand where the camera saw through before? Asked three voxels
  /// behind it: of the object itself that is inside, where no view ever looked, while its skin may have been
  /// grazed.
  [[nodiscard]] bool stands_in_free_space(const IntPoint& p,
                                          const FixedPose& model_from_camera) const noexcept;

  /// Distance (1/256 mm) between the eight nodes around a point that the cube holds, and its gradient as a
  /// unit vector (Q14). False where one of the nodes was never seen or the surface is too far to be told.
  [[nodiscard]] bool sample(const IntPoint& p, std::int32_t& distance, IntPoint& gradient) const noexcept;

  /// Blocks hold nodes once a surface came near.
  [[nodiscard]] bool active(int block) const noexcept {
    return active_[static_cast<std::size_t>(block)] != 0;
  }
  /// Activates the blocks that a surface at `p` (held by the cube) concerns.
  void activate_around(const IntPoint& p) noexcept;
  /// Views fused into an active block are counted up to kOften.
  void count_fusion(int block) noexcept {
    std::uint8_t& count = active_[static_cast<std::size_t>(block)];
    if (count < kOften) ++count;
  }
  [[nodiscard]] bool fused_often(int block) const noexcept {
    return active_[static_cast<std::size_t>(block)] >= kOften;
  }
  /// The camera saw through all of an inactive block.
  void saw_through(int block) noexcept {
    std::uint8_t& seen = free_[static_cast<std::size_t>(block)];
    if (seen < 255) ++seen;
  }
  /// Looks through a block after which it counts as free.
  static constexpr std::uint8_t kFreeLooks = 4;
  static constexpr std::uint8_t kOften = 9;

 private:
  [[nodiscard]] std::size_t index(int x, int y, int z) const noexcept {
    return row_major(z * plan_.cells + y, plan_.cells, x);
  }
  [[nodiscard]] int node(std::int32_t x) const noexcept {
    return static_cast<int>(((x + plan_.half() + plan_.voxel / 2) * per_unit_) >> 24);
  }
  [[nodiscard]] std::size_t block_of(const IntPoint& p) const noexcept {
    const int blocks = plan_.blocks();
    return row_major(node(p.z) / kBlock * blocks + node(p.y) / kBlock, blocks, node(p.x) / kBlock);
  }
  void activate(int block) noexcept;

  VolumePlan plan_;
  std::int64_t per_unit_ = 0;  // nodes per 1/16 mm, Q24
  std::span<Voxel> voxels_;
  std::span<std::uint8_t> active_;  // a block each: 0 inactive, else one more than its fusions
  std::span<std::uint8_t> free_;    // a block each: looks through it
};

}  // namespace pliant

// Finds the part of a region that moves rigidly in a way of its own: a connected set of patches that the warp
// has taken along one rigid motion, clearly another than the region's (paper, section 3.2: the same again on
// the outliers).
#pragma once

#include "core/deform/patch_warp.hpp"
#include "core/track/patches.hpp"

namespace pliant {

struct PartSearchSettings {
  std::uint32_t fewest_points = 40;  ///< seen, of the part
  double limit = 0.004;              ///< the inlier test's limit, metres
};

struct RigidPart {
  PatchSet patches;
  RigidTransform pose;  ///< camera <- model
};

/// The part of region `k`, whose pose is `region`, that leaves most unexplained by the region's own motion,
/// among those that are most of what moved there, what bends being no part, and whose readings tell how they
/// moved. False when there is none.
[[nodiscard]] bool find_rigid_part(const PatchTables& patches, const PatchWarp& warp, std::int8_t k,
                                   const RigidTransform& region, const PartSearchSettings& settings,
                                   RigidPart& part) noexcept;

/// How far patch `p` is from where `pose` would put it, mean square over the patch, metres squared.
[[nodiscard]] double patch_deviation(const PatchTables& patches, const PatchWarp& warp, std::size_t p,
                                     const RigidTransform& pose) noexcept;

/// The rigid motion that suits the seen patches of a set best, from `start` on.
[[nodiscard]] RigidTransform fit_patches(const PatchTables& patches, const PatchWarp& warp,
                                         const PatchSet& set, const RigidTransform& start) noexcept;

/// What of a region, as far as it is seen, stands where a pose puts it: within half of the inlier limit.
struct Hold {
  double seen = 0, standing = 0;  ///< weighted readings
  PatchSet patches;               ///< that stand

  /// Less than half: any rigid part is a better hold on the object.
  [[nodiscard]] bool lost() const noexcept { return 2 * standing < seen; }
};

[[nodiscard]] Hold hold_of(const PatchTables& patches, const PatchWarp& warp, std::int8_t k,
                           const RigidTransform& pose, double limit) noexcept;

/// Has enough been seen of patch `p` for its motion to count?
[[nodiscard]] inline bool patch_counts(const PatchWarp& warp, std::size_t p) noexcept {
  return warp.seen[p] >= 3;
}

}  // namespace pliant

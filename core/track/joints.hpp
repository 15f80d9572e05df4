// Where regions hang on each other: a part turns at its joint, it does not slide off it.
#pragma once

#include "core/deform/patch_warp.hpp"

namespace pliant {

/// A region's tie to what it borders on, in one frame.
struct Joint {
  bool tied = false;
  Vector3 place = Vector3::Zero();         ///< the middle of the border, model frame, metres
  Vector3 target = Vector3::Zero();        ///< where the other side has it, camera frame, metres
  double give = 0;                         ///< how far the two lie apart, one standard deviation, metres
  Matrix3 rotation = Matrix3::Identity();  ///< of the parent, camera <- model
  double turn = 0;  ///< how far the region turns off that, one standard deviation, radians; 0: not known
};

using Joints = std::array<Joint, limits::kMaxRegions>;

/// Ties every region but the base to the patches on the other side of its border: to its parent's, or to any
/// where it does not touch its parent. The other side is where its region's motion since the last frame takes
/// it; `regions` hold the poses of now, `warp` those of the last frame.
[[nodiscard]] Joints find_joints(const PatchTables& patches, const PatchWarp& warp,
                                 const RegionSet& regions) noexcept;

/// Where region k hangs on `parent`: the middle of the border between them, model frame, metres. False where
/// they do not touch.
[[nodiscard]] bool find_joint(const PatchTables& patches, const PatchWarp& warp, std::int8_t k,
                              std::int8_t parent, Vector3& joint) noexcept;

}  // namespace pliant

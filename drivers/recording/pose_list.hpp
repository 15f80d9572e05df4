// Lists of poses in TUM's layout.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/rigid_transform.hpp"
#include "drivers/common/result.hpp"

namespace pliant {

struct StampedPose {
  double seconds = 0;
  Vector3 place = Vector3::Zero();  ///< metres
  Quaternion turn;

  [[nodiscard]] RigidTransform transform() const { return {rotation_from_quaternion(turn), place}; }
};

/// Reads lines "<seconds> tx ty tz qx qy qz qw"; empty ones and comments (#) are passed over. In the order of
/// time. An ErrorKind::bad_input names the file, the line and what is wrong with it.
[[nodiscard]] Result<std::vector<StampedPose>> read_pose_list(const std::string& path);

/// The pose of the same time, at most 2 ms away; null where there is none. `poses` in the order of time.
[[nodiscard]] const StampedPose* pose_at(const std::vector<StampedPose>& poses, double seconds);

}  // namespace pliant

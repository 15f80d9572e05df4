#include "firmware-app/pictures/trajectory_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/recording/pose_list.hpp"

namespace pliant {

Result<std::vector<PoseError>> trajectory_errors(const std::string& path, const std::string& truth) {
  const Result<std::vector<StampedPose>> found = read_pose_list(path);
  if (!found) return found.error();
  const Result<std::vector<StampedPose>> real = read_pose_list(truth);
  if (!real) return real.error();
  std::vector<PoseError> errors;
  for (const StampedPose& pose : *found) {
    const StampedPose* const companion = pose_at(*real, pose.seconds);
    if (companion == nullptr) continue;
    const Matrix3 turn =
        rotation_from_quaternion(companion->turn).transpose() * rotation_from_quaternion(pose.turn);
    errors.push_back({pose.seconds - found->front().seconds, (pose.place - companion->place).norm(),
                      std::acos(std::clamp(cos_angle(turn), -1.0, 1.0)) * 180 / std::numbers::pi});
  }
  if (errors.empty())
    return Error{ErrorKind::bad_input,
                 fmt::format("no pose of {} has one of the same time in {}", path, truth)};
  return errors;
}

}  // namespace pliant

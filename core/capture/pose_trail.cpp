#include "core/capture/pose_trail.hpp"

#include <algorithm>

#include "core/geometry/vector6.hpp"

namespace pliant {

void PoseTrail::begin(const RigidTransform& pose, std::int64_t frame) noexcept {
  pose_ = before_ = pose;
  frame_ = frame_before_ = frame;
}

void PoseTrail::add(const RigidTransform& pose, std::int64_t frame) noexcept {
  before_ = pose_;
  frame_before_ = frame_;
  pose_ = pose;
  frame_ = frame;
}

RigidTransform PoseTrail::predict(std::int64_t frame) const noexcept {
  RigidTransform predicted = pose_;
  const auto gap = std::min<std::int64_t>(3, frame - frame_);
  if (frame_ - frame_before_ != 1 || gap < 1) return predicted;
  const RigidTransform motion = pose_ * before_.inverse();
  for (std::int64_t i = 0; i < gap; ++i) predicted = motion * predicted;
  predicted.rotation = orthonormalised(predicted.rotation);
  return predicted;
}

double PoseTrail::moved(double radius) const noexcept {
  const Vector6 motion = motion_between(pose_, before_, pose_.translation);
  const auto pictures = static_cast<double>(std::max<std::int64_t>(1, frame_ - frame_before_));
  return (motion.head<3>().norm() * radius + motion.tail<3>().norm()) / pictures;
}

}  // namespace pliant

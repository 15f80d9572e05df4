// Where the object was in the last two pictures, and where it is expected in the next.
#pragma once

#include <cstdint>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

class PoseTrail {
 public:
  /// The first pose (camera <- model), of picture `frame`.
  void begin(const RigidTransform& pose, std::int64_t frame) noexcept;
  void add(const RigidTransform& pose, std::int64_t frame) noexcept;

  [[nodiscard]] const RigidTransform& pose() const noexcept { return pose_; }
  /// In picture `frame`: the object goes on as it went, for the pictures that are missing too, at most three.
  [[nodiscard]] RigidTransform predict(std::int64_t frame) const noexcept;
  /// How far a point `radius` metres from the middle moved from picture to picture of late, metres.
  [[nodiscard]] double moved(double radius) const noexcept;

 private:
  RigidTransform pose_, before_;
  std::int64_t frame_ = 0, frame_before_ = 0;
};

}  // namespace pliant

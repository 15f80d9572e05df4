// Poses that agree: single matches propose poses that are off by what their local frames are off, too far for
// thin limbs to meet the picture. That several keypoints propose about the same pose tells right ones from
// chance (pose clustering: Stockman, Object recognition and localization via pose clustering, CVGIP 1987).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/point_grid.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/memory/workspace.hpp"

namespace pliant {

/// Gathers the poses of a whole search. Work a pose is bounded by kMostNeighbours.
class PoseVotes {
 public:
  static constexpr std::size_t kMostNeighbours = 192;  ///< agreeing places looked at for a pose
  static constexpr std::size_t kMostSpent = 512;

  void lay_out(Workspace& workspace, std::size_t poses, std::size_t keypoints) noexcept;
  /// `centre` and `radius`: of the model, metres.
  void start(const Vector3& centre, double radius) noexcept;
  void clear() noexcept { count_ = spent_count_ = 0; }

  /// One pose more (scene <- model); `keypoint` counts up over the whole search. Ignored when full.
  void add(const RigidTransform& pose, std::size_t keypoint) noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  /// To be called after the last add() and before count_votes().
  void index() noexcept;
  /// Votes of the poses [first, last): keypoints that propose a pose at about the same place and attitude.
  /// Poses before `first` that they agree with gain theirs.
  void count_votes(std::size_t first, std::size_t last) noexcept;

  /// The mean of pose k and those that it agrees with.
  [[nodiscard]] RigidTransform mean_pose(std::size_t k) const noexcept;
  [[nodiscard]] std::uint32_t votes(std::size_t k) const noexcept { return votes_[k]; }
  /// The poses with the most votes, each of a cluster of its own that holds no spent pose, by falling votes;
  /// returns how many.
  [[nodiscard]] std::size_t best(std::span<std::uint32_t> out) noexcept;
  /// Pose k was looked at closely.
  void spend(std::size_t k) noexcept {
    if (spent_count_ < spent_.size()) spent_[spent_count_++] = static_cast<std::uint32_t>(k);
  }

 private:
  struct Turn {
    float w, x, y, z;
  };
  [[nodiscard]] RigidTransform pose_from(const Vector3& place, const Quaternion& turn) const noexcept {
    RigidTransform pose;
    pose.rotation = rotation_from_quaternion(turn);
    pose.translation = place - pose.rotation * centre_;
    return pose;
  }
  [[nodiscard]] bool alike(std::size_t a, std::size_t b) const noexcept {
    return same_place(a, b) && same_attitude(a, b);
  }
  [[nodiscard]] static bool same_attitude(const Turn& p, const Turn& q) noexcept;
  [[nodiscard]] bool same_attitude(std::size_t a, std::size_t b) const noexcept {
    return same_attitude(turns_[a], turns_[b]);
  }
  [[nodiscard]] bool same_place(std::size_t a, std::size_t b) const noexcept;

  std::span<Point3f> places_;  // where each pose puts the model's centre
  std::span<Turn> turns_;
  std::span<std::uint32_t> keypoint_;  // that proposes it
  std::span<std::uint16_t> votes_;
  std::span<std::uint32_t> last_voter_;  // keypoint + 1: one keypoint's poses give one vote
  std::span<std::uint32_t> heard_;       // by keypoint: pose + 1 that it voted for last
  std::span<std::uint32_t> order_;
  std::array<std::uint32_t, kMostSpent> spent_;
  std::size_t spent_count_ = 0;
  PointGrid grid_;
  std::size_t count_ = 0;
  Vector3 centre_ = Vector3::Zero();
  float reach_ = 0;  // metres
};

}  // namespace pliant

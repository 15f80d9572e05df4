#include "core/detect/pose_votes.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

// Two frames of which each is off by 15° or so, and what that shifts the centre by at half a radius' lever.
constexpr double kReach = 0.25;           // of the model's radius
constexpr float kHalfTurnCosine = 0.96F;  // of half the angle between two poses: within 32°
constexpr std::uint32_t kFewestVotes = 1;

}  // namespace

void PoseVotes::lay_out(Workspace& workspace, std::size_t poses, std::size_t keypoints) noexcept {
  places_ = workspace.take<Point3f>(poses);
  turns_ = workspace.take<Turn>(poses);
  keypoint_ = workspace.take<std::uint32_t>(poses);
  votes_ = workspace.take<std::uint16_t>(poses);
  last_voter_ = workspace.take<std::uint32_t>(poses);
  heard_ = workspace.take<std::uint32_t>(keypoints);
  order_ = workspace.take<std::uint32_t>(poses);
  grid_.lay_out(workspace, poses);
  count_ = 0;
}

void PoseVotes::start(const Vector3& centre, double radius) noexcept {
  centre_ = centre;
  reach_ = static_cast<float>(kReach * radius);
  count_ = spent_count_ = 0;
}

void PoseVotes::add(const RigidTransform& pose, std::size_t keypoint) noexcept {
  if (count_ == places_.size() || keypoint >= heard_.size()) return;
  const Vector3 place = pose * centre_;
  const Quaternion q = quaternion_from_rotation(pose.rotation);
  places_[count_] = to_point(place);
  turns_[count_] = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
                    static_cast<float>(q.z)};
  keypoint_[count_] = static_cast<std::uint32_t>(keypoint);
  votes_[count_] = 0;
  last_voter_[count_] = 0;
  heard_[keypoint] = 0;
  ++count_;
}

void PoseVotes::index() noexcept {
  static_cast<void>(grid_.build(places_.first(count_), static_cast<double>(reach_)));
}

bool PoseVotes::same_attitude(const Turn& p, const Turn& q) noexcept {
  return std::fabs(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z) > kHalfTurnCosine;
}

bool PoseVotes::same_place(std::size_t a, std::size_t b) const noexcept {
  const Point3f &p = places_[a], &q = places_[b];
  const float x = p.x - q.x, y = p.y - q.y, z = p.z - q.z;
  return x * x + y * y + z * z < reach_ * reach_;
}

void PoseVotes::count_votes(std::size_t first, std::size_t last) noexcept {
  for (std::size_t k = first; k < std::min(last, count_); ++k) {
    const std::uint32_t own = keypoint_[k];
    grid_.visit_within(places_[k], reach_, kMostNeighbours,
                       [&](std::uint32_t j, const Point3f& /*place*/, float /*square*/) {
                         if (keypoint_[j] == own || !same_attitude(j, k)) return;
                         const auto mark = static_cast<std::uint32_t>(k + 1);
                         if (heard_[keypoint_[j]] != mark) {
                           heard_[keypoint_[j]] = mark;
                           ++votes_[k];
                         }
                         // Poses of [first, last) hear each other on their own turn.
                         if (j < first && last_voter_[j] != own + 1) {
                           last_voter_[j] = own + 1;
                           ++votes_[j];
                         }
                       });
  }
}

RigidTransform PoseVotes::mean_pose(std::size_t k) const noexcept {
  Vector3 place = Vector3::Zero();
  const Turn& own = turns_[k];
  Quaternion turn{0, 0, 0, 0};
  int count = 0;
  grid_.visit_within(places_[k], reach_, kMostNeighbours,
                     [&](std::uint32_t j, const Point3f& p, float /*square*/) {
                       if (!same_attitude(j, k)) return;
                       const Turn& t = turns_[j];
                       const float cosine = own.w * t.w + own.x * t.x + own.y * t.y + own.z * t.z;
                       const double sign = cosine < 0 ? -1 : 1;
                       turn.w += sign * static_cast<double>(t.w);
                       turn.x += sign * static_cast<double>(t.x);
                       turn.y += sign * static_cast<double>(t.y);
                       turn.z += sign * static_cast<double>(t.z);
                       place += to_vector(p);
                       ++count;
                     });
  const double length = std::sqrt(turn.w * turn.w + turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
  return pose_from(place / count, {turn.w / length, turn.x / length, turn.y / length, turn.z / length});
}

std::size_t PoseVotes::best(std::span<std::uint32_t> out) noexcept {
  std::size_t candidates = 0;
  for (std::size_t k = 0; k < count_; ++k)
    if (votes_[k] >= kFewestVotes) order_[candidates++] = static_cast<std::uint32_t>(k);
  // Clusters of many poses stand for one place: some of the best may go.
  const std::size_t looked = std::min(candidates, 16 * out.size());
  std::partial_sort(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(looked),
                    order_.begin() + static_cast<std::ptrdiff_t>(candidates),
                    [&](std::uint32_t a, std::uint32_t b) {
                      return votes_[a] != votes_[b] ? votes_[a] > votes_[b] : a < b;
                    });
  std::size_t count = 0;
  for (std::size_t i = 0; i < looked && count < out.size(); ++i) {
    bool known = false;
    for (std::size_t c = 0; c < count && !known; ++c) known = alike(out[c], order_[i]);
    for (std::size_t c = 0; c < spent_count_ && !known; ++c) known = alike(spent_[c], order_[i]);
    if (!known) out[count++] = order_[i];
  }
  return count;
}

}  // namespace pliant

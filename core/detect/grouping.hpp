// Geometric-consistency grouping (Chen, Bhanu: 3D free-form object recognition in range images using local
// surface patches, PRL 2007), the paper's section 3.2, in bounded time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/match_lanes.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// A correspondence with the local frames at both ends.
struct PosedMatch {
  Point3f model, scene;                 ///< metres
  LocalFrame model_frame, scene_frame;  ///< rows are the axes in the model's and the scene's frame
  std::int32_t quality = 0;             ///< the larger the better: the dot product of the descriptors
};

/// A set of correspondences that agree on one rigid transform.
struct MatchGroup {
  RigidTransform transform;  ///< scene <- model
  std::uint32_t members = 0;
};

struct GroupingSettings {
  double tolerance = 0.01;  ///< by how much distances within the model and the scene may differ, metres, > 0
  double frame_tolerance = 0.15;  ///< by how much a local frame may be off, radians: what a seed's pose
                                  ///< allows a match to be off grows with its distance from the seed by this
  bool use_frames = true;         ///< off: pairwise distances alone
  std::uint32_t seeds = 256;      ///< matches from which groups are grown, the best first [1, 1024]
  std::uint32_t least = 4;        ///< members of a group worth having [3, …]
};

/// Every seed (a match with its local frames: a full pose) gathers the matches that its pose explains and
/// that keep their distance to it: the order of matches plays no part, there is no greedy start, and the time
/// is seeds × matches. Within the best groups, members that are inconsistent with most of the others (pair by
/// pair, on bits) are dropped before the transform is solved.
class Grouping {
 public:
  static constexpr std::size_t kMostGroups = 8;
  static constexpr std::size_t kMostMembers = 256;  ///< looked at pair by pair

  void lay_out(Workspace& workspace, std::size_t matches) noexcept;
  /// The best groups at distinct poses, best first; at most groups.size(). `radius`: of the model, metres, to
  /// tell poses apart.
  [[nodiscard]] std::size_t group(std::span<const PosedMatch> matches, const GroupingSettings& settings,
                                  double radius, std::span<MatchGroup> groups) noexcept;

 private:
  struct Seed {
    std::uint32_t index, count;
  };
  /// Numbers of the matches that `pose` explains to members_; returns how many.
  [[nodiscard]] std::size_t gather(std::size_t matches, const RigidTransform& pose, const Point3f& around,
                                   double tolerance, double growth) noexcept;
  [[nodiscard]] std::size_t collect_hits(std::size_t matches) noexcept;
  [[nodiscard]] std::size_t drop_inconsistent(std::span<const PosedMatch> matches, std::size_t count,
                                              double tolerance) noexcept;

  std::span<std::uint32_t> order_;
  std::span<Seed> seeds_;
  std::span<std::uint32_t> members_;
  std::span<std::uint64_t> bits_;
  MatchLanes lanes_;
  std::span<std::int32_t> hits_;
};

/// The rigid transform scene <- model with the least squared distances over `matches[members[...]]` (Horn
/// 1987, by quaternions). False with fewer than three members or when they lie on a line.
[[nodiscard]] bool rigid_fit(std::span<const PosedMatch> matches, std::span<const std::uint32_t> members,
                             RigidTransform& transform) noexcept;

/// The pose that one match proposes by itself.
[[nodiscard]] RigidTransform pose_from_frames(const PosedMatch& match) noexcept;

}  // namespace pliant

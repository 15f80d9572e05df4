// How well a pose of the model explains a depth picture: agreement and free space.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/detect/depth_snapshot.hpp"
#include "core/detect/probe_points.hpp"
#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// Counts of model points that face the camera under a pose.
struct PoseEvidence {
  int facing = 0;        ///< all of the counts below
  int agreeing = 0;      ///< lie on the observed surface, with its normal
  int close = 0;         ///< of the agreeing ones, are off by no more than 3 σ: noise alone explains it
  int floating = 0;      ///< lie in front of the observed surface: impossible, the camera sees through them
  int behind = 0;        ///< lie behind the observed surface: hidden by something
  int outside = 0;       ///< lie outside the picture or where there is no reading
  int crossing = 0;      ///< lie on the observed surface but with another normal
  double agreement = 0;  ///< of the agreeing points, each with how closely it agrees, [0, 1]

  double impossible = 0;  ///< of the floating points, each with how far in front it floats, [0, 1]

  /// Share of the agreeing points that noise alone does not put where they are: next to nothing for the
  /// object itself, a tenth to a third for something of a like shape.
  [[nodiscard]] double unexplained() const noexcept {
    return agreeing > 0 ? static_cast<double>(agreeing - close) / agreeing : 1;
  }
  /// agreement − 1.5 · impossible − 0.3 · (behind, outside, crossing), as a share of the facing points: at
  /// most 1. Something that floats is impossible, something hidden or unseen merely unlikely.
  [[nodiscard]] double score() const noexcept {
    if (facing == 0) return -10;
    return (agreement - 1.5 * impossible - 0.3 * (behind + outside + crossing)) / facing;
  }
};

/// Looks the first `count` points up in the snapshot under `pose` (camera <- model). A point lies on the
/// surface seen at its pixel when it is off by less than `tolerance` + 3 σ of the depth there, at most `most`
/// (metres, along the point's normal). How closely it agrees falls off with the square of the distance, and
/// with the angle between the normals from 25° to none at 60°. Points seen at more than 80° from their normal
/// are not counted.
[[nodiscard]] PoseEvidence pose_evidence(const ProbePoints& points, const DepthSnapshot& snapshot,
                                         const RigidTransform& pose, std::size_t count, double tolerance,
                                         double most, double plain_weight = 1) noexcept;

}  // namespace pliant

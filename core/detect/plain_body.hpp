// Does a plain body explain what is seen better than the model does?
#pragma once

#include <cstddef>

#include "core/detect/depth_snapshot.hpp"
#include "core/detect/probe_points.hpp"
#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// Mean squared distances of the readings that lie on the posed model, metres².
struct PlainBodyFit {
  int readings = 0;    ///< 0: too few to tell
  double model = 0;    ///< from the model
  double quadric = 0;  ///< from the quadric that fits them best
  double capped = 0;   ///< from a plane and a quadric, the nearer of both: a tube that shows its end
  double faces = 0;    ///< from the up to three planes that fit them best
  double noise = 0;    ///< what the sensor's readings scatter by

  /// Nearer than the model by more than noise explains: something plain of the object's size rather than the
  /// object.
  [[nodiscard]] bool quadric_is_nearer() const noexcept;
  [[nodiscard]] bool faces_are_nearer() const noexcept;
  /// Planes, or a quadric and a plane, are nearer, and noise alone puts the readings where they are.
  [[nodiscard]] bool pieces_explain() const noexcept;
};

/// Looks the first `count` points (at most kMostPlainPoints) up as pose_evidence() does, with the same
/// tolerances.
inline constexpr std::size_t kMostPlainPoints = 608;
[[nodiscard]] PlainBodyFit plain_body_fit(const ProbePoints& points, const DepthSnapshot& snapshot,
                                          const RigidTransform& pose, std::size_t count, double tolerance,
                                          double most) noexcept;

}  // namespace pliant

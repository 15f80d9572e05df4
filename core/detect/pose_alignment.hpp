// Poses brought nearer to what a depth picture shows.
#pragma once

#include <cstddef>

#include "core/detect/depth_snapshot.hpp"
#include "core/detect/probe_points.hpp"
#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// A gate that narrows over the steps from `gate` (metres) to three times `tolerance`, each beside 3 σ.
struct AlignSchedule {
  double gate = 0, tolerance = 0;
  int steps = 1;

  [[nodiscard]] double reach(int step) const noexcept {
    const double share = steps > 1 ? static_cast<double>(step) / (steps - 1) : 0;
    return gate + (3 * tolerance - gate) * share;
  }
};

/// One step of projective point-to-plane alignment (Chen, Medioni 1992; Blais, Levine 1995) of the first
/// `count` points with Tukey's weights: what lies `reach` metres and 3 σ off has none. Returns how firmly the
/// pose held before the step: the sum of the weights as a share of the points that face the camera. Negative
/// when too few points hold on to the surface; the pose is then left alone.
[[nodiscard]] double align_step(const ProbePoints& points, const DepthSnapshot& snapshot, std::size_t count,
                                double reach, RigidTransform& pose) noexcept;

/// All steps of a schedule, until too few points hold on; returns how many were begun.
int align_pose(const ProbePoints& points, const DepthSnapshot& snapshot, std::size_t count,
               const AlignSchedule& schedule, RigidTransform& pose) noexcept;

}  // namespace pliant

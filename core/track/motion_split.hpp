// Finds the part of a region that moves in another way than the rest, while the difference is still small.
//
// After alignment, the residuals of each patch say how well a small further motion x of the region would suit
// it: its point-to-plane energy E(x) = xᵀA x − 2 bᵀx + c is known exactly for every x without another look at
// the picture. Two motions with a connected set of patches each, that together explain the region clearly
// better than one, make two regions.
#pragma once

#include <Eigen/Core>

#include "core/fixed/moments.hpp"
#include "core/track/patches.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Energy of a patch as a function of a small motion: rotation vector about `centre` (radians), translation
/// (metres). Energies are in metres squared, summed over weighted points.
struct PatchEnergy {
  Matrix6 a;
  Vector6 b;
  double c = 0;
  double points = 0;  ///< sum of weights

  [[nodiscard]] double at(const Vector6& x) const noexcept { return c - 2 * b.dot(x) + x.dot(a * x); }
};

/// Scratch of the search and what it found.
struct MotionSplit {
  std::array<PlaneMoments, kMaxPatches> moments;
  std::array<PatchEnergy, kMaxPatches> energy;
  std::array<std::uint32_t, kMaxPatches> members;  ///< model points of the region in the patch

  PatchSet part;               ///< patches of the part that moves away
  RigidTransform part_motion;  ///< camera frame, to go before the region's pose
  RigidTransform rest_motion;
  double part_rms_before = 0,
         part_rms = 0;  ///< of the part's residuals under the rest's motion and its own, metres
};

struct MotionSplitSettings {
  std::uint32_t fewest_points = 40;  ///< seen, of each side
  double noise = 0.001;              ///< of a residual, metres
  double moved = 0.003;  ///< residuals of a part that moved away, metres; below, it is the model's misfit
};

/// Looks for a split of region `k`; `points.correspondences` must hold its points under its current pose with
/// a wide gate. True when a split was found that is significant and stays joined.
bool find_motion_split(const ModelTables& model, const PatchTables& patches, const RegionSet& regions,
                       std::int8_t k, const MotionSplitSettings& settings, const PointState& points,
                       MotionSplit& split) noexcept;

}  // namespace pliant

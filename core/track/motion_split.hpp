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
  Matrix6 a = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  double c = 0;
  double points = 0;  ///< sum of weights

  PatchEnergy& operator+=(const PatchEnergy& e) noexcept {
    a += e.a;
    b += e.b;
    c += e.c;
    points += e.points;
    return *this;
  }

  [[nodiscard]] double at(const Vector6& x) const noexcept { return c - 2 * b.dot(x) + x.dot(a * x); }
};

/// Scratch of the search and what it found.
struct MotionSplit {
  std::array<PlaneMoments, kMaxPatches> moments;
  std::array<PatchEnergy, kMaxPatches> energy;
  std::array<std::uint32_t, kMaxPatches> members;  ///< model points of the region in the patch

  PatchSet part;                         ///< patches of the part that moves away
  PatchEnergy part_energy, rest_energy;  ///< sums over the part's patches and the others
  Vector3 centre = Vector3::Zero();      ///< that motions turn about, camera frame, metres
};

/// What ties a part to its neighbour: its displacement at `arm` (from the energies' centre, metres) should be
/// `displacement`, at `stiffness` in weighted points.
struct JointSpring {
  Vector3 arm = Vector3::Zero();
  Vector3 displacement = Vector3::Zero();
  double stiffness = 0;
};

/// Stiffness of a border: every edge that crosses it is a spring that gives by one spacing where a reading is
/// off by its noise (metres).
[[nodiscard]] inline double joint_stiffness(std::uint32_t edges, double noise,
                                            const ModelTables& model) noexcept {
  const double ratio = noise * kUnitsPerMetre / model.spacing;
  return edges * ratio * ratio;
}

/// The motion of least energy, with a weak prior on no motion and, if given, a joint.
[[nodiscard]] Vector6 best_motion(const PatchEnergy& energy, double noise,
                                  const JointSpring* spring) noexcept;
[[nodiscard]] RigidTransform motion_about(const Vector6& x, const Vector3& centre) noexcept;

struct MotionSplitSettings {
  std::uint32_t fewest_points = 40;  ///< seen, of each side
  double noise = 0.001;              ///< of a residual, metres
  double moved = 0.003;  ///< residuals of a part that moved away, metres; below, it is the model's misfit
};

/// Looks for a split of region `k`; `points.correspondences` must hold its points under its current pose with
/// a wide gate. True when a significant one was found.
bool find_motion_split(const PatchTables& patches, std::int8_t k, const MotionSplitSettings& settings,
                       const PointState& points, MotionSplit& split) noexcept;

}  // namespace pliant

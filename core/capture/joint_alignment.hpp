// Aligns all kept views to each other at once: closes the drift when the first view comes round again.
#pragma once

#include <span>

#include "core/capture/keyframes.hpp"
#include "core/memory/workspace.hpp"

namespace pliant {

struct JointFit {
  std::uint32_t pairs = 0;  ///< of views that see the same surface, in the last round
  double before = 0;        ///< root mean square of the distances between views, metres
  double after = 0;         ///< the same at the end
  double moved = 0;         ///< the farthest that a view's camera was moved, metres
};

/// Every pair of views that look at the same side gives the exact sums of its point-to-plane rows; all views
/// but the first move so that the sum over all pairs is least (Lu, Milios: Globally consistent range scan
/// alignment, Autonomous Robots 1997, with dense rows; Pulli, 3DIM 1999). A fixed number of rounds.
class JointAlignment {
 public:
  void lay_out(Workspace& workspace) noexcept;
  /// Changes the poses of `views`.
  [[nodiscard]] JointFit run(std::span<Keyframe> views, const Projector& projector, const Surface& rays,
                             std::int32_t noise, double gate, std::span<PlaneRow> rows) noexcept;

 private:
  static constexpr std::size_t kUnknowns = 6 * kMaxKeyframes;
  /// Solves the dense symmetric equations in place; false when they are singular.
  [[nodiscard]] bool solve(std::size_t unknowns) noexcept;

  std::span<double> matrix_, right_;  // kUnknowns squared, row by row; kUnknowns
};

}  // namespace pliant

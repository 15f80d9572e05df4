// Does the scene's surface end where the model ends? A pose that buries the model in a wall or a larger body
// agrees with what is seen, yet the surface goes on seamlessly beyond the model's outline.
#pragma once

#include <cstddef>

#include "core/detect/depth_snapshot.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

struct SeamEvidence {
  int ring = 0;      ///< places just outside of what agrees with the model that have a reading
  int seamless = 0;  ///< of these, where the surface seen inside goes on with its normal

  [[nodiscard]] double share() const noexcept { return ring > 0 ? static_cast<double>(seamless) / ring : 0; }
};

/// Draws the outline of model points [0, count) under `pose` (camera <- model) on a coarse grid whose cells
/// span about the points' spacing, and looks at the cells around it. `tolerance`: metres, beside 2 σ.
[[nodiscard]] SeamEvidence seam_evidence(const ModelView& model, const DepthSnapshot& snapshot,
                                         const RigidTransform& pose, std::size_t count,
                                         double tolerance) noexcept;

}  // namespace pliant

// Whether a view fits what was fused, and finding the object again after it was lost.
#pragma once

#include <span>

#include "core/capture/background.hpp"
#include "core/capture/keyframes.hpp"
#include "core/capture/view_alignment.hpp"

namespace pliant {

/// A view that goes on from the one before: three quarters of the readings that can be judged agree, and not
/// more than twice as many are new.
[[nodiscard]] bool fits(const ViewFit& fit) noexcept;
/// A view of which nothing was known beforehand: a thing looks like itself from other sides, too, so nearly
/// all that can be judged must agree.
[[nodiscard]] bool surely_fits(const ViewFit& fit) noexcept;

/// Could the object stand so before the camera? Of the points of the kept views hardly any lie behind one of
/// the planes that are seen: things do not reach through tables and walls. `pose`: camera <- model.
[[nodiscard]] bool stands_before(std::span<const Keyframe> kept, const RigidTransform& pose,
                                 std::span<const BackgroundPlane> planes, std::int32_t noise) noexcept;

/// What the search looks with.
struct SearchTools {
  const DistanceVolume& volume;
  const Projector& projector;
  const Surface& rays;
  const ViewAlignSettings& align;
  std::span<PlaneRow> rows;  ///< scratch, kViewPoints
};

/// Aligns `points` to the latest kept views, each with a reach of some centimetres, the first from
/// `last_pose`, the others from their own. False when no answer is sure.
[[nodiscard]] bool find_again(std::span<const ViewPoint> points, std::span<const Keyframe> kept,
                              const RigidTransform& last_pose, const SearchTools& tools,
                              ViewFit& fit) noexcept;

}  // namespace pliant

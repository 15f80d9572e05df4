// Whether the object stood in the same pixels while it was captured.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/capture/view_picture.hpp"
#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// The pixels that figures on the likeness of neighbouring pixels' errors are told in: those of a PrimeSense
/// sensor at 640×480. Its errors' correlation (of still scenes) is 0.45 at two pixels, 0.25 at four and 0.15
/// at six. Smaller pictures of it are thinned out.
inline constexpr double kSensorFocal = 570;

/// A sensor errs by its pixels: readings of one pixel err alike from picture to picture, and so do readings
/// of pixels whose matching windows overlap. Of an object that stands in the same pixels the errors are fused
/// like shape, and then hold it where it is. Remembers the poses of the views fused last.
class Standstill {
 public:
  void clear() noexcept { count_ = 0; }
  /// A view at `pose` (camera <- model) was fused.
  void add(const RigidTransform& pose) noexcept;
  /// Of the fused views the share in which `points`, seen from `pose`, stood within kAlike of the direction
  /// in which they stand now [0, 1]; 1 when none was fused.
  [[nodiscard]] double share(std::span<const ViewPoint> points, const RigidTransform& pose) const noexcept;

  /// Four of kSensorFocal's pixels, at which errors are alike by a quarter; of the line of sight's tangent.
  static constexpr double kAlike = 4 / kSensorFocal;
  /// As many straight views as a node's running mean goes back (ViewFuser::kMostWeight).
  static constexpr std::size_t kViews = 128;

 private:
  std::array<RigidTransform, kViews> poses_;
  std::size_t count_ = 0;  // of all that came
};

}  // namespace pliant

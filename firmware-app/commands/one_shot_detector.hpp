// The tracker's own search in single pictures, without a tracker around it.
#pragma once

#include <memory>

#include "core/detect/frame_detector.hpp"
#include "drivers/common/result.hpp"
#include "firmware-app/pipeline/memory_block.hpp"

namespace pliant {

class OneShotDetector {
 public:
  /// `model`'s memory must outlive it. ErrorKind::device without memory for it.
  [[nodiscard]] static Result<std::unique_ptr<OneShotDetector>> create(const ModelView& model,
                                                                       const Intrinsics& camera,
                                                                       const SensorDescription& sensor);
  /// Searches a picture to the end, about 0.1 s on a PC; true when the object was found: best() is where.
  [[nodiscard]] bool look(const DepthFrame& frame);
  [[nodiscard]] const Detection& best() const noexcept { return detector_.best(); }
  /// All poses that were looked at closely in that picture, in no order.
  [[nodiscard]] std::span<const PoseCandidate> candidates() const noexcept { return detector_.candidates(); }

 private:
  OneShotDetector() = default;

  MemoryBlock block_;
  Surface surface_;
  FrameDetector detector_;
};

}  // namespace pliant

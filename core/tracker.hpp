// The tracker: one model, one camera, one depth frame after the other.
#pragma once

#include <cstddef>
#include <span>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/model/model_view.hpp"
#include "core/track_result.hpp"
#include "core/track_settings.hpp"

namespace pliant {

struct TrackerState;

/// Finds the model in depth frames and follows it. Allocation-free: all memory is the block given to start().
/// Not thread-safe; one thread calls process().
class Tracker {
 public:
  /// Bytes of the block that start() needs for this model, camera and settings.
  [[nodiscard]] static std::size_t workspace_bytes(const ModelView& model, const Intrinsics& camera,
                                                   const TrackSettings& settings) noexcept;

  /// Lays out the block (aligned to Workspace::kAlignment) and prepares all tables. Null when well, else what
  /// is wrong in words. `model`'s memory and the block must outlive the tracker.
  [[nodiscard]] const char* start(const ModelView& model, const Intrinsics& camera,
                                  const SensorDescription& sensor, const TrackSettings& settings,
                                  std::span<std::byte> block) noexcept;

  /// One frame. A frame of another size than the camera's is not used (TrackResult::frame_used).
  [[nodiscard]] const TrackResult& process(const DepthFrame& frame) noexcept;

  /// Called after each stage of process().
  void observe(const StageObserver& observer) noexcept;

  /// How much work a frame may cost: 1 (all) down to 0 (least). Points and iterations shrink by rule.
  /// What lies beyond counts as the end that it lies beyond, what is not a number as 0.
  void set_work_level(double level) noexcept;

  /// The next frame looks for the object near `pose` (camera <- model) instead of searching for it.
  void start_from(const RigidTransform& pose) noexcept;

  /// Forgets the object: the next frame searches everywhere.
  void reset() noexcept;

 private:
  TrackerState* state_ = nullptr;  // inside the block
};

}  // namespace pliant

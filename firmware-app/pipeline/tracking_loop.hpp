// The tracking thread's work: frame by frame from the ring through the tracker to the outputs.
#pragma once

#include <cstdint>
#include <string>

#include "core/tracker.hpp"
#include "firmware-app/measure/frame_rate.hpp"
#include "firmware-app/measure/latency_meter.hpp"
#include "firmware-app/measure/path_cost.hpp"
#include "firmware-app/outputs/frame_files.hpp"
#include "firmware-app/outputs/output_hash.hpp"
#include "firmware-app/pipeline/capture.hpp"
#include "firmware-app/pipeline/run_figures.hpp"
#include "firmware-app/pipeline/work_controller.hpp"

namespace pliant {

/// Sees every frame with its result, on the tracking thread: it must be quick and make no heap call.
struct FrameWitness {
  void (*seen)(void* context, const DepthFrame& frame, const TrackResult& result) = nullptr;
  void* context = nullptr;
};

class TrackingLoop {
 public:
  /// Everything is borrowed. `publisher` and `files` may be null.
  struct Parts {
    FrameRing& ring;
    const Capture& capture;
    Tracker& tracker;
    TrackMessages& messages;
    LcmPublisher* publisher = nullptr;
    FrameFiles* files = nullptr;
    LatencyMeter& latency;
    PathCost& cost;
    LiveFigures& live;
    FrameWitness witness;
  };
  struct Settings {
    std::int64_t budget_ns = 0;       ///< 0: no work is ever shed
    bool wait_for_publisher = false;  ///< no message gives way to a newer one
    bool hash = false;                ///< output_sha256 is wanted
    bool publish_depth = false;
    Intrinsics camera;
    std::string_view version, source;
    std::uint64_t model_id = 0;
    std::uint64_t workspace_bytes = 0;
  };
  TrackingLoop(const Parts& parts, const Settings& settings);

  /// Until the ring is closed and empty.
  void run(RunFigures& figures);
  /// Tells how the run ended; after run() and when the source is closed.
  void publish_end(const RunFigures& figures);

 private:
  void take(const CapturedFrame& captured, RunFigures& figures);
  void hand_over(const CapturedFrame& captured, const TrackResult& result);
  void publish_status_if_due(const RunFigures& figures, bool state_changed);
  void publish_status(const RunFigures& figures);
  void fill_device(StatusContent& status) const;
  /// What a slow stream leaves of the confidence in a result.
  [[nodiscard]] float trust() const noexcept;

  Parts parts_;
  const Settings settings_;
  WorkController work_;
  StageProfile recent_;  // since the last status
  OutputHash hash_;
  std::int64_t first_arrival_ns_ = 0, last_status_ns_ = 0;
  FrameRate rate_;
  std::int64_t last_frame_ = -1;
  DeviceState told_device_ = DeviceState::absent;  // by the last status
  StreamFault told_fault_ = StreamFault::none;
  bool told_blind_ = true;
};

}  // namespace pliant

// A whole run: capture, tracking, publishing and files, each on a thread of its own.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model_view.hpp"
#include "core/track_settings.hpp"
#include "drivers/depth_source/depth_source.hpp"
#include "firmware-app/outputs/frame_files.hpp"
#include "firmware-app/pipeline/run_figures.hpp"
#include "firmware-app/pipeline/tracking_loop.hpp"

namespace pliant {

struct RunSettings {
  std::string source_name;  ///< as the user gave it
  std::string version;
  SensorDescription sensor;
  TrackSettings track;
  std::string lcm_url;  ///< "none" publishes nothing
  std::string lcm_prefix = "PLIANT";
  bool add_to_log = false;  ///< see LcmSettings
  bool publish_depth = false;
  bool realtime = false;          ///< frames come at their stamps' pace and the newest wins
  std::int64_t frame_limit = -1;  ///< frames to take from the source, -1 for all
  double budget_ms = 33;          ///< for one frame; only with a source that does not wait
  int priority = 0;               ///< of the tracking thread, see WorkerSettings
  std::vector<int> affinity;
  FrameFilesSettings files;
  bool lock_memory = false;  ///< everything the process holds, not only the workspace
  bool hash = false;
  std::optional<RigidTransform> start_pose;  ///< where the first frame looks for the object, camera <- model
  FrameWitness witness;
  /// Called every 20 ms on the calling thread while the run goes on; may be empty.
  std::function<void(const LiveFigures&)> progress;
  /// Asked as often: true ends this run, the source stays open for another. May be empty.
  std::function<bool()> leave;
  /// Called with a line that the user should read now; may be empty.
  std::function<void(const std::string&)> warn;
};

/// How a run that could start ended.
struct RunEnd {
  RunFigures figures;
  std::int64_t taken = 0;     ///< frames taken from the source, bad ones included
  bool stopped = false;       ///< by SIGINT or SIGTERM
  bool left = false;          ///< because RunSettings::leave said so
  bool source_hangs = false;  ///< it did not come back: the caller must end the process without closing it
  bool device_lost = false;
  std::string fault;          ///< the latest fault of the source, empty when there was none
  bool files_failed = false;  ///< a write failed; `warn` was told
  bool log_failed = false;    ///< so did one of the messages' log
};

/// Runs until the source ends, the limit is reached, the device is lost or a StopSignal comes. An error when
/// it cannot start.
[[nodiscard]] Result<RunEnd> run_pipeline(DepthSource& source, const ModelView& model,
                                          const RunSettings& settings);

}  // namespace pliant

// What a run came to.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/track_result.hpp"
#include "drivers/lcm/publisher.hpp"
#include "firmware-app/measure/histogram.hpp"
#include "firmware-app/measure/stage_profile.hpp"

namespace pliant {

struct RunFigures {
  std::int64_t tracked = 0, lost = 0, searching = 0;  ///< frames by state
  std::int64_t dropped = 0;                           ///< frames the tracker had no time for
  std::int64_t bad_frames = 0;                        ///< frames that could not be used
  std::int64_t deadline_misses = 0;
  double least_work_level = 1;
  std::int64_t files_left_out = 0;  ///< frames whose files the disk had no time for
  TrackState last_state = TrackState::searching;
  std::int64_t first_tracked = -1;  ///< number of the first tracked frame
  RigidTransform last_pose;         ///< of the base region in the latest tracked frame
  float last_strain_energy = 0;     ///< of the latest tracked frame
  StageProfile profile;
  Histogram latency;   ///< capture to publish
  double seconds = 0;  ///< from the first frame's arrival to the last one's end
  std::uint64_t heap_calls = 0, page_faults = 0;
  bool heap_watched = true;
  std::uint64_t workspace_bytes = 0;
  bool workspace_locked = false;
  std::uint64_t resident_bytes = 0;  ///< of the process, at its highest
  SendCounters sent;
  std::string output_sha256;

  [[nodiscard]] std::int64_t frames() const { return tracked + lost + searching; }
};

/// What the status line shows while the run goes on. Written by the tracking thread.
struct LiveFigures {
  std::atomic<std::int64_t> frame{-1}, frames{0}, tracked{0};
  std::atomic<TrackState> state{TrackState::searching};
  std::atomic<std::int64_t> last_total_ns{0};
  std::atomic<float> confidence{0};
  std::atomic<int> regions{0};
  std::atomic<std::int64_t> deadline_misses{0};
  std::atomic<double> work_level{1};
  /// Signs of life, see Beats; `captured` is written by the supervising thread.
  std::atomic<std::uint64_t> captured{0}, begun{0}, finished{0};
};

}  // namespace pliant

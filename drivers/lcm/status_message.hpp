// The status message, encoded into a buffer of fixed size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/track_result.hpp"
#include "drivers/lcm/messages.hpp"

namespace pliant {

inline constexpr std::size_t kMaxStatusStages = 16;
inline constexpr std::size_t kMaxStatusStageName = 31;
inline constexpr std::size_t kMaxStatusText = 255;  ///< characters of version, source and last_error

struct StageTimes {
  std::string_view name;  ///< up to kMaxStatusStageName characters
  std::int32_t median_us = 0, p99_us = 0, max_us = 0;
};

/// What a status message says; the texts are borrowed for the call. Meaning and units as in
/// types/status_t.lcm.
struct StatusContent {
  std::int64_t utime = 0;  ///< now, µs since the epoch
  std::string_view version, source;
  std::uint64_t model_id = 0;  ///< ModelHeader::checksum
  std::int64_t frame = -1;
  TrackState state = TrackState::searching;
  DeviceState device = DeviceState::absent;
  StreamFault stream_fault = StreamFault::none;
  float rate = 0;           ///< frames a second
  float strain_energy = 0;  ///< of the latest tracked frame; 0 unless tracking
  std::int32_t latency_median_us = 0, latency_p99_us = 0, latency_max_us = 0;
  std::span<const StageTimes> stages;  ///< up to kMaxStatusStages, the last one "total"
  std::int64_t tracked = 0, searching = 0, lost = 0, dropped = 0, bad_frames = 0, deadline_misses = 0;
  std::int64_t zero_frames = 0, stuck_frames = 0, noise_frames = 0, wrong_size_frames = 0, delayed_frames = 0,
               slow_frames = 0, broken_frames = 0, stalls = 0, reopenings = 0;  ///< DeviceMonitor
  std::int64_t unsent = 0, send_failures = 0;                                   ///< LcmPublisher::counters()
  std::int64_t workspace_bytes = 0, rss_bytes = 0, heap_calls = 0, page_faults = 0;
  std::string_view last_error;
};

/// Bytes that every status message fits.
inline constexpr std::size_t kMaxStatusBytes =
    320 + 3 * (kMaxStatusText + 5) + kMaxStatusStages * (kMaxStatusStageName + 5 + 12);

/// The body, inside `buffer`; empty when the buffer is too small (not with kMaxStatusBytes). Longer texts and
/// further stages are cut. Allocation-free.
[[nodiscard]] std::span<const std::uint8_t> encode_status(const StatusContent& content,
                                                          std::span<std::uint8_t> buffer) noexcept;

}  // namespace pliant

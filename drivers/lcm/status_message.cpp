#include "drivers/lcm/status_message.hpp"

#include <algorithm>

#include "drivers/lcm/fingerprint.hpp"
#include "drivers/lcm/wire.hpp"

namespace pliant {

std::span<const std::uint8_t> encode_status(const StatusContent& content,
                                            std::span<std::uint8_t> buffer) noexcept {
  wire::Writer out(buffer);
  out.put<std::uint64_t>(wire::kStatusFingerprint);
  out.put<std::int64_t>(content.utime);
  out.put_string(content.version, kMaxStatusText);
  out.put_string(content.source, kMaxStatusText);
  out.put<std::uint64_t>(content.model_id);
  out.put<std::int64_t>(content.frame);
  out.put<std::int8_t>(static_cast<std::int8_t>(content.state));
  out.put<std::int8_t>(static_cast<std::int8_t>(content.device));
  out.put<std::int8_t>(static_cast<std::int8_t>(content.stream_fault));
  out.put<float>(content.rate);
  out.put<float>(content.strain_energy);
  out.put<std::int32_t>(content.latency_median_us);
  out.put<std::int32_t>(content.latency_p99_us);
  out.put<std::int32_t>(content.latency_max_us);
  const auto stages = content.stages.first(std::min(content.stages.size(), kMaxStatusStages));
  out.put<std::int32_t>(static_cast<std::int32_t>(stages.size()));
  for (const StageTimes& stage : stages) out.put_string(stage.name, kMaxStatusStageName);
  for (const StageTimes& stage : stages) out.put<std::int32_t>(stage.median_us);
  for (const StageTimes& stage : stages) out.put<std::int32_t>(stage.p99_us);
  for (const StageTimes& stage : stages) out.put<std::int32_t>(stage.max_us);
  for (const std::int64_t counter : {content.tracked,        content.searching,     content.lost,
                                     content.dropped,        content.bad_frames,    content.zero_frames,
                                     content.stuck_frames,   content.noise_frames,  content.wrong_size_frames,
                                     content.delayed_frames, content.slow_frames,   content.broken_frames,
                                     content.stalls,         content.reopenings,    content.deadline_misses,
                                     content.unsent,         content.send_failures, content.workspace_bytes,
                                     content.rss_bytes,      content.heap_calls,    content.page_faults}) {
    out.put<std::int64_t>(counter);
  }
  out.put_string(content.last_error, kMaxStatusText);
  return out.ok() ? out.written() : std::span<const std::uint8_t>{};
}

}  // namespace pliant

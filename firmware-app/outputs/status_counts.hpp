// What a status counts, by name, the same in tables, logs and the viewer.
#pragma once

#include <array>
#include <cstdint>

#include "drivers/lcm/messages.hpp"

namespace pliant {

struct NamedCount {
  const char* name;  ///< as in types/status_t.lcm
  std::int64_t StatusMessage::*count;
};

/// In the order of the message.
inline constexpr std::array<NamedCount, 21> kStatusCounts = {{
    {"tracked", &StatusMessage::tracked},
    {"searching", &StatusMessage::searching},
    {"lost", &StatusMessage::lost},
    {"dropped", &StatusMessage::dropped},
    {"bad_frames", &StatusMessage::bad_frames},
    {"zero_frames", &StatusMessage::zero_frames},
    {"stuck_frames", &StatusMessage::stuck_frames},
    {"noise_frames", &StatusMessage::noise_frames},
    {"wrong_size_frames", &StatusMessage::wrong_size_frames},
    {"delayed_frames", &StatusMessage::delayed_frames},
    {"slow_frames", &StatusMessage::slow_frames},
    {"broken_frames", &StatusMessage::broken_frames},
    {"stalls", &StatusMessage::stalls},
    {"reopenings", &StatusMessage::reopenings},
    {"deadline_misses", &StatusMessage::deadline_misses},
    {"unsent", &StatusMessage::unsent},
    {"send_failures", &StatusMessage::send_failures},
    {"workspace_bytes", &StatusMessage::workspace_bytes},
    {"rss_bytes", &StatusMessage::rss_bytes},
    {"heap_calls", &StatusMessage::heap_calls},
    {"page_faults", &StatusMessage::page_faults},
}};

}  // namespace pliant

// Whether multicast works on this host, found out before LCM is asked: LCM prints pages and waits ten
// seconds.
#pragma once

#include <cstddef>
#include <string>

#include "drivers/lcm/lcm_url.hpp"

namespace pliant {

/// Null when the kernel knows a way to the group, else why not. No packet is sent, nothing is allocated.
[[nodiscard]] const char* multicast_route_fault(const LcmUrl& url) noexcept;

/// Sends a few bytes to the group on a port of its own and waits at most 200 ms for them to come back.
/// Subscribers on this host hear nothing where they do not.
[[nodiscard]] bool multicast_comes_back(const LcmUrl& url) noexcept;

/// One line: `fault` and the commands that mend it.
[[nodiscard]] std::string multicast_advice(const LcmUrl& url, std::string_view fault);

/// Where the URL lets messages leave this host (ttl above 0) but multicast is routed to the loopback: one
/// line with the command that mends it. Empty when all is well.
[[nodiscard]] std::string multicast_reach_advice(const LcmUrl& url);

/// Where a subscriber on this host has less room for messages on their way than `needed` bytes, sent in one
/// go: one line with the command that mends it. Empty when there is room.
[[nodiscard]] std::string receive_buffer_advice(const LcmUrl& url, std::size_t needed);

}  // namespace pliant

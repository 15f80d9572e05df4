// An LCM URL, checked before LCM sees it: LCM itself prints, aborts or misbehaves on what is wrong.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/common/result.hpp"

namespace pliant {

/// Keeps traffic on this host.
inline constexpr std::string_view kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";

struct LcmUrl {
  enum class Provider { udp_multicast, in_process, log_file };

  Provider provider = Provider::udp_multicast;
  std::uint32_t group = 0;  ///< IPv4 multicast address, host byte order; udp_multicast only
  std::uint16_t port = 0;   ///< udp_multicast only
  std::string group_text;   ///< dotted
  int ttl = 0;              ///< networks that messages may cross, 0: this host only; udp_multicast only
  int receive_buffer = 0;   ///< bytes asked for, 0: the system's default; udp_multicast only
  bool writes = true;       ///< false for a log file that is read
  bool append = false;      ///< what a log file holds stays, new messages come behind it
  std::string path;         ///< log_file only
  std::string spelled;      ///< in full, for lcm_create()

  [[nodiscard]] bool writes_log() const { return provider == Provider::log_file && writes; }

  /// udpm://[group][:port][?ttl=0..255&recv_buf_size=bytes], memq:// or file://PATH[?mode=r|w|a&speed=&…].
  /// Empty: the environment's LCM_DEFAULT_URL, else kDefaultLcmUrl.
  [[nodiscard]] static Result<LcmUrl> parse(std::string_view text);
};

/// Checks a channel prefix: 1 to 54 letters, digits, '_', '-', '.' or '/'.
[[nodiscard]] Outcome check_channel_prefix(std::string_view prefix);

}  // namespace pliant

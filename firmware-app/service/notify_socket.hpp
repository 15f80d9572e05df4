// Tells the service manager how the program fares: systemd's notification protocol, datagrams of NAME=VALUE
// lines on the Unix socket that $NOTIFY_SOCKET names (sd_notify(3)).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/common/result.hpp"

namespace pliant {

class NotifySocket {
 public:
  NotifySocket() = default;
  NotifySocket(NotifySocket&& other) noexcept;
  NotifySocket& operator=(NotifySocket&& other) noexcept;
  ~NotifySocket();

  /// Connected to `address`: a path, or a name in the abstract namespace with '@' before it. Empty: one that
  /// is not active. ErrorKind::bad_input when there is no such socket.
  [[nodiscard]] static Result<NotifySocket> open(const std::string& address);

  [[nodiscard]] bool active() const noexcept { return descriptor_ >= 0; }
  /// Never waits. False when the message did not go out, also when not active.
  bool send(std::string_view lines) noexcept;

 private:
  int descriptor_ = -1;
};

/// The time in which the service manager wants to hear from this process, in nanoseconds; 0 when it does not.
/// From $WATCHDOG_USEC and $WATCHDOG_PID.
[[nodiscard]] std::int64_t watchdog_interval_ns(const char* microseconds, const char* process);

}  // namespace pliant

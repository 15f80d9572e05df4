// Keeps the service manager informed of a run: ready, how it fares, alive.
#pragma once

#include <cstdint>
#include <string>

#include "firmware-app/service/liveness.hpp"
#include "firmware-app/service/notify_socket.hpp"

namespace pliant {

class ServiceLink {
 public:
  /// `watchdog_ns` 0: no pings.
  ServiceLink(NotifySocket socket, std::int64_t watchdog_ns) noexcept;
  /// From the environment; a socket that cannot be reached is told in `warning` and done without.
  [[nodiscard]] static ServiceLink from_environment(std::string& warning);

  [[nodiscard]] bool active() const noexcept { return socket_.active(); }
  /// Call it often. READY=1 at the first life; a ping four times in the watchdog's interval while there is
  /// life.
  void update(const Beats& beats, std::int64_t now_ns) noexcept;
  /// One line for `systemctl status`, at most once a second; others are dropped.
  void tell(const std::string& line, std::int64_t now_ns);
  /// RELOADING=1; update() says READY=1 again.
  void reloading(std::int64_t now_ns);
  /// STOPPING=1 with a last line.
  void stopping(const std::string& line);

 private:
  NotifySocket socket_;
  Liveness liveness_;
  std::int64_t ping_every_ns_ = 0;
  std::int64_t next_ping_ns_ = 0;
  std::int64_t next_line_ns_ = 0;
  bool ready_ = false;
};

}  // namespace pliant

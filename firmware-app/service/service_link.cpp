#include "firmware-app/service/service_link.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

namespace pliant {

ServiceLink::ServiceLink(NotifySocket socket, std::int64_t watchdog_ns) noexcept
    : socket_(std::move(socket)), ping_every_ns_(watchdog_ns / 4) {}

ServiceLink ServiceLink::from_environment(std::string& warning) {
  const char* address = std::getenv("NOTIFY_SOCKET");
  Result<NotifySocket> socket = NotifySocket::open(address == nullptr ? "" : address);
  if (!socket) {
    warning = socket.error().message + "; the service manager will not hear of this run";
    return {NotifySocket(), 0};
  }
  return {std::move(*socket),
          watchdog_interval_ns(std::getenv("WATCHDOG_USEC"), std::getenv("WATCHDOG_PID"))};
}

void ServiceLink::update(const Beats& beats, std::int64_t now_ns) noexcept {
  if (!socket_.active()) return;
  const bool ping_due = ping_every_ns_ > 0 && now_ns >= next_ping_ns_;
  if ((ready_ && !ping_due) || !liveness_.look(beats)) return;
  if (!ready_) ready_ = socket_.send("READY=1");
  if (ping_due && socket_.send("WATCHDOG=1")) next_ping_ns_ = now_ns + ping_every_ns_;
}

void ServiceLink::tell(const std::string& line, std::int64_t now_ns) {
  if (!socket_.active() || now_ns < next_line_ns_) return;
  next_line_ns_ = now_ns + 1'000'000'000;
  static_cast<void>(socket_.send(fmt::format("STATUS={}", line)));
}

void ServiceLink::reloading(std::int64_t now_ns) {
  ready_ = false;
  static_cast<void>(socket_.send(fmt::format("RELOADING=1\nMONOTONIC_USEC={}", now_ns / 1000)));
}

void ServiceLink::stopping(const std::string& line) {
  static_cast<void>(socket_.send(fmt::format("STOPPING=1\nSTATUS={}", line)));
}

}  // namespace pliant

#include "firmware-app/service/notify_socket.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <utility>

namespace pliant {

NotifySocket::NotifySocket(NotifySocket&& other) noexcept {
  *this = std::move(other);
}

NotifySocket& NotifySocket::operator=(NotifySocket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

NotifySocket::~NotifySocket() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<NotifySocket> NotifySocket::open(const std::string& address) {
  NotifySocket socket_;
  if (address.empty()) return socket_;
  sockaddr_un where{};
  if (address.size() >= sizeof where.sun_path || (address.front() != '/' && address.front() != '@'))
    return Error{ErrorKind::bad_input,
                 fmt::format("NOTIFY_SOCKET '{}' is neither a path nor '@' and a name", address)};
  where.sun_family = AF_UNIX;
  std::memcpy(where.sun_path, address.data(), address.size());
  if (address.front() == '@') where.sun_path[0] = '\0';
  socket_.descriptor_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address.size());
  const auto* place = static_cast<const sockaddr*>(static_cast<const void*>(&where));
  if (socket_.descriptor_ < 0 || connect(socket_.descriptor_, place, length) != 0)
    return Error{ErrorKind::bad_input,
                 fmt::format("cannot reach NOTIFY_SOCKET '{}': {}", address, std::strerror(errno))};
  return socket_;
}

bool NotifySocket::send(std::string_view lines) noexcept {
  return descriptor_ >= 0 && ::send(descriptor_, lines.data(), lines.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
                                 static_cast<ssize_t>(lines.size());
}

std::int64_t watchdog_interval_ns(const char* microseconds, const char* process) {
  const auto number = [](const char* text) {
    std::int64_t value = 0;
    if (text == nullptr) return value;
    const char* end = text + std::strlen(text);
    const auto [stop, fault] = std::from_chars(text, end, value);
    return fault == std::errc() && stop == end ? value : 0;
  };
  if (process != nullptr && number(process) != getpid()) return 0;
  const std::int64_t wanted = number(microseconds);
  return wanted > 0 && wanted < INT64_MAX / 1000 ? wanted * 1000 : 0;
}

}  // namespace pliant

// The service manager's end of the notification socket.
#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace pliant::test {

class FakeManager {
 public:
  explicit FakeManager(const std::string& path) : path_(path) {
    descriptor_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_un where{};
    where.sun_family = AF_UNIX;
    std::memcpy(where.sun_path, path.data(), path.size());
    const auto* place = static_cast<const sockaddr*>(static_cast<const void*>(&where));
    if (path.size() >= sizeof where.sun_path || bind(descriptor_, place, sizeof where) != 0)
      ADD_FAILURE() << "no socket at " << path;
  }
  FakeManager(const FakeManager&) = delete;
  FakeManager& operator=(const FakeManager&) = delete;
  ~FakeManager() { close(descriptor_); }

  [[nodiscard]] const std::string& path() const { return path_; }
  /// The next datagram, "" when none came in time.
  [[nodiscard]] std::string receive(int timeout_ms) const {
    pollfd wait{descriptor_, POLLIN, 0};
    if (poll(&wait, 1, timeout_ms) <= 0) return "";
    char text[4096];
    const ssize_t length = recv(descriptor_, text, sizeof text, 0);
    return length > 0 ? std::string(text, static_cast<std::size_t>(length)) : "";
  }
  /// Whether a datagram with `part` comes in time.
  [[nodiscard]] bool hears(const std::string& part, int timeout_ms) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
    while (std::chrono::steady_clock::now() < end)
      if (receive(50).find(part) != std::string::npos) return true;
    return false;
  }
  /// How many datagrams with `part` come within a time.
  [[nodiscard]] int count(const std::string& part, int span_ms) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(span_ms);
    int number = 0;
    while (std::chrono::steady_clock::now() < end)
      if (receive(20).find(part) != std::string::npos) ++number;
    return number;
  }

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace pliant::test

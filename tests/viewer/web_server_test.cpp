// The web server, spoken to by what is no browser.
#include "firmware-app/viewer/web_server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <vector>

namespace pliant::viewer {
namespace {

/// A connection to the server, closed at its end; what does not come within ten seconds does not come.
class Visitor {
 public:
  explicit Visitor(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval most{10, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
    const auto* address = static_cast<const sockaddr*>(static_cast<const void*>(&place));
    EXPECT_EQ(::connect(socket_, address, sizeof place), 0);
  }
  Visitor(Visitor&& other) noexcept : socket_(other.socket_) { other.socket_ = -1; }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;
  Visitor& operator=(Visitor&&) = delete;
  ~Visitor() {
    if (socket_ >= 0) ::close(socket_);
  }
  /// The answer to a request for the stream; empty where the server hangs up.
  [[nodiscard]] std::string ask_for_stream(const std::string& key) const {
    const std::string request =
        "GET /stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: " +
        key + "\r\nSec-WebSocket-Version: 13\r\n\r\n";
    EXPECT_EQ(::send(socket_, request.data(), request.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(request.size()));
    std::array<char, 512> answer{};
    const ssize_t length = ::recv(socket_, answer.data(), answer.size(), 0);
    return length > 0 ? std::string(answer.data(), static_cast<std::size_t>(length)) : "";
  }

 private:
  int socket_;
};

constexpr const char* kKey = "dGhlIHNhbXBsZSBub25jZQ==";

bool is_let_in(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 101");
}

TEST(ViewerWebServer, AHandshakeThatFailsTakesNoPlace) {
  Stream stream;
  const auto server = WebServer::start("127.0.0.1", 0, "", stream);
  ASSERT_TRUE(server) << server.error().message;
  const int port = (*server)->port();
  for (int i = 0; i < WebServer::kMostViewers; ++i)
    EXPECT_FALSE(is_let_in(Visitor(port).ask_for_stream(std::string(200, 'k'))));
  EXPECT_TRUE(is_let_in(Visitor(port).ask_for_stream(kKey)));
}

TEST(ViewerWebServer, HasSoManyPlacesAndGivesThemAnew) {
  Stream stream;
  const auto server = WebServer::start("127.0.0.1", 0, "", stream);
  ASSERT_TRUE(server) << server.error().message;
  const int port = (*server)->port();
  std::vector<Visitor> viewers;
  for (int i = 0; i < WebServer::kMostViewers; ++i) {
    viewers.emplace_back(port);
    EXPECT_TRUE(is_let_in(viewers.back().ask_for_stream(kKey))) << i;
  }
  EXPECT_FALSE(is_let_in(Visitor(port).ask_for_stream(kKey)));
  viewers.pop_back();
  bool let_in = false;
  for (int i = 0; i < 100 && !let_in; ++i) {
    ::usleep(50'000);
    let_in = is_let_in(Visitor(port).ask_for_stream(kKey));
  }
  EXPECT_TRUE(let_in);
}

}  // namespace
}  // namespace pliant::viewer

#include "firmware-app/service/notify_socket.hpp"

#include <sys/socket.h>

#include "tests/commands/program.hpp"
#include "tests/service/fake_manager.hpp"

namespace pliant::test {
namespace {

class Notify : public CommandTest {};

TEST_F(Notify, LinesArriveAsOneDatagram) {
  const FakeManager manager(at("notify"));
  Result<NotifySocket> socket = NotifySocket::open(manager.path());
  ASSERT_TRUE(socket) << socket.error().message;
  EXPECT_TRUE(socket->active());
  EXPECT_TRUE(socket->send("READY=1\nSTATUS=well"));
  EXPECT_EQ(manager.receive(1000), "READY=1\nSTATUS=well");
}

TEST_F(Notify, AManagerThatDoesNotReadNeverHoldsTheSenderUp) {
  const FakeManager manager(at("notify"));
  Result<NotifySocket> socket = NotifySocket::open(manager.path());
  ASSERT_TRUE(socket);
  bool refused = false;
  for (int i = 0; i < 100'000 && !refused; ++i) refused = !socket->send("WATCHDOG=1");
  EXPECT_TRUE(refused);
}

TEST_F(Notify, NoAddressIsNoSocket) {
  Result<NotifySocket> socket = NotifySocket::open("");
  ASSERT_TRUE(socket);
  EXPECT_FALSE(socket->active());
  EXPECT_FALSE(socket->send("READY=1"));
}

TEST_F(Notify, AWrongAddressIsToldOf) {
  EXPECT_FALSE(NotifySocket::open("relative"));
  EXPECT_FALSE(NotifySocket::open("/" + std::string(200, 'x')));
  const Result<NotifySocket> nobody = NotifySocket::open(at("nobody"));
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().message.find("nobody"), std::string::npos);
}

TEST_F(Notify, TheWatchdogsIntervalIsReadStrictly) {
  const std::string self = std::to_string(getpid());
  EXPECT_EQ(watchdog_interval_ns("2000000", nullptr), 2'000'000'000);
  EXPECT_EQ(watchdog_interval_ns("2000000", self.c_str()), 2'000'000'000);
  EXPECT_EQ(watchdog_interval_ns("2000000", "1"), 0);  // meant for another process
  for (const char* wrong : {"", "0", "-5", "5s", "99999999999999999999"})
    EXPECT_EQ(watchdog_interval_ns(wrong, nullptr), 0) << wrong;
  EXPECT_EQ(watchdog_interval_ns(nullptr, nullptr), 0);
}

}  // namespace
}  // namespace pliant::test

#include "firmware-app/service/service_link.hpp"

#include "tests/commands/program.hpp"
#include "tests/service/fake_manager.hpp"

namespace pliant::test {
namespace {

constexpr std::int64_t kMs = 1'000'000;

class Link : public CommandTest {
 protected:
  Link() : manager_(at("notify")) {}
  [[nodiscard]] ServiceLink link() const {
    Result<NotifySocket> socket = NotifySocket::open(manager_.path());
    EXPECT_TRUE(socket);
    return {std::move(*socket), 400 * kMs};
  }
  FakeManager manager_;
};

TEST_F(Link, IsReadyAtTheFirstLifeAndPingsWhileThereIsSome) {
  ServiceLink link = this->link();
  link.update({0, 0, 0}, 0);
  EXPECT_EQ(manager_.receive(0), "");
  link.update({1, 0, 0}, 0);
  EXPECT_EQ(manager_.receive(100), "READY=1");
  EXPECT_EQ(manager_.receive(100), "WATCHDOG=1");
  int pings = 0;
  for (std::int64_t ms = 0; ms <= 1000; ms += 20) {
    link.update({2 + static_cast<std::uint64_t>(ms), 0, 0}, ms * kMs);
    while (manager_.receive(0) == "WATCHDOG=1") ++pings;
  }
  EXPECT_EQ(pings, 10);
}

TEST_F(Link, PingsStopWhenFramesStop) {
  ServiceLink link = this->link();
  link.update({1, 1, 1}, 0);
  EXPECT_EQ(manager_.receive(100), "READY=1");
  EXPECT_EQ(manager_.receive(100), "WATCHDOG=1");
  for (std::int64_t ms = 0; ms <= 1000; ms += 20) link.update({1, 1, 1}, ms * kMs);
  EXPECT_EQ(manager_.receive(50), "");
  link.update({2, 1, 1}, 1000 * kMs);
  EXPECT_EQ(manager_.receive(100), "WATCHDOG=1");
}

TEST_F(Link, SaysThatItReloadsAndIsReadyAgain) {
  ServiceLink link = this->link();
  link.update({1, 0, 0}, 0);
  EXPECT_EQ(manager_.receive(100), "READY=1");
  EXPECT_EQ(manager_.receive(100), "WATCHDOG=1");
  link.reloading(5000 * kMs);
  EXPECT_EQ(manager_.receive(100), "RELOADING=1\nMONOTONIC_USEC=5000000");
  link.update({2, 0, 0}, 0);
  EXPECT_EQ(manager_.receive(100), "READY=1");
}

TEST_F(Link, LinesComeOnceASecond) {
  ServiceLink link = this->link();
  for (std::int64_t ms = 0; ms < 1000; ms += 20) link.tell("well", ms * kMs);
  EXPECT_EQ(manager_.receive(100), "STATUS=well");
  EXPECT_EQ(manager_.receive(0), "");
  link.stopping("over");
  EXPECT_EQ(manager_.receive(100), "STOPPING=1\nSTATUS=over");
}

}  // namespace
}  // namespace pliant::test

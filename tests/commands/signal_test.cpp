// SIGINT and SIGTERM end a run with its outputs whole.
#include <signal.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "drivers/lcm/subscriber.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

class Signals : public CommandTest, public testing::WithParamInterface<int> {};

TEST_P(Signals, EndARunWell) {
  const pid_t process =
      start_pliant({"run", "--source", "simulated:cushion?frames=100000&width=320&height=240", "--pace",
                    "realtime", "--lcm-url", "file://" + at("log") + "?mode=w", "--stats", at("s.json"),
                    "--trajectory", at("t.txt"), "--points", at("points")},
                   folder_);
  // The first points file shows that the run is well under way.
  for (int i = 0; i < 1000; ++i) {
    std::error_code ignored;
    if (std::filesystem::exists(at("points")) && count_files(at("points")) > 3) break;
    usleep(20'000);
  }
  kill(process, GetParam());
  const Ended ended = wait_for(process, folder_);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const nlohmann::json stats = nlohmann::json::parse(read_file(at("s.json")));
  const auto tracked = stats["tracked"].get<std::size_t>();
  EXPECT_GT(tracked, 0U);
  const std::string trajectory = read_file(at("t.txt"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(trajectory.begin(), trajectory.end(), '\n')), tracked);
  EXPECT_EQ(count_files(at("points")), tracked);

  // The last word about the device is that it was closed.
  StatusMessage last;
  LcmSubscriber::Handlers handlers;
  handlers.status = [&last](const StatusMessage& status) { last = status; };
  auto log = LcmSubscriber::create("file://" + at("log") + "?speed=0", "PLIANT", handlers);
  ASSERT_TRUE(log) << log.error().message;
  while ((*log)->handle(100) >= 0) {
  }
  EXPECT_GE((*log)->counters().of(MessageKind::status), 2);
  EXPECT_EQ(last.device, DeviceState::ended);
  EXPECT_EQ(static_cast<std::size_t>(last.tracked), tracked);
}

INSTANTIATE_TEST_SUITE_P(Both, Signals, testing::Values(SIGINT, SIGTERM),
                         [](const auto& about) { return about.param == SIGINT ? "SIGINT" : "SIGTERM"; });

}  // namespace
}  // namespace pliant::test

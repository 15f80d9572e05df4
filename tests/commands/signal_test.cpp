// SIGINT, SIGTERM and, of a terminal that closes, SIGHUP end a run with its outputs whole.
#include <signal.h>
#include <unistd.h>

#include <csignal>
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

INSTANTIATE_TEST_SUITE_P(All, Signals, testing::Values(SIGINT, SIGTERM, SIGHUP), [](const auto& about) {
  return about.param == SIGINT ? "SIGINT" : about.param == SIGTERM ? "SIGTERM" : "SIGHUP";
});

/// Waits until `folder` holds more than three files.
void wait_for_files(const std::string& folder) {
  for (int i = 0; i < 1000; ++i) {
    std::error_code ignored;
    if (std::filesystem::exists(folder, ignored) && count_files(folder) > 3) return;
    usleep(20'000);
  }
}

class Hangup : public CommandTest {
 protected:
  [[nodiscard]] pid_t start_recording() const {
    const pid_t process = start_pliant(
        {"record", "--source", "simulated:cushion?frames=100000&width=320&height=240", "-o", at("r")},
        folder_);
    wait_for_files(at("r/depth"));
    return process;
  }
};

TEST_F(Hangup, EndsARecordingWell) {
  const pid_t process = start_recording();
  // From the shell and from the kernel.
  kill(process, SIGHUP);
  usleep(1000);
  kill(process, SIGHUP);
  const Ended ended = wait_for(process, folder_);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("recorded "), std::string::npos) << ended.out;
}

TEST_F(Hangup, IsIgnoredWhereItWas) {
  const auto handler = std::signal(SIGHUP, SIG_IGN);  // as nohup does
  const pid_t process = start_recording();
  std::signal(SIGHUP, handler);
  kill(process, SIGHUP);
  const std::size_t files = count_files(at("r/depth"));
  for (int i = 0; i < 500 && count_files(at("r/depth")) < files + 10; ++i) usleep(20'000);
  EXPECT_GE(count_files(at("r/depth")), files + 10) << "it goes on";
  kill(process, SIGTERM);
  EXPECT_EQ(wait_for(process, folder_).code, 0);
}

}  // namespace
}  // namespace pliant::test

// The program under a service manager: ready, pings, reload, end.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>

#include "drivers/lcm/lcm_log.hpp"
#include "drivers/lcm/messages.hpp"
#include "tests/commands/program.hpp"
#include "tests/service/fake_manager.hpp"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

class Service : public CommandTest {
 protected:
  Service() : manager_(at("notify")) {}
  ~Service() override {
    if (process_ > 0) kill(process_, SIGKILL);
  }

  void start(const std::vector<std::string>& options) {
    std::vector<std::string> words = {"run"};
    words.insert(words.end(), options.begin(), options.end());
    setenv("NOTIFY_SOCKET", manager_.path().c_str(), 1);
    setenv("WATCHDOG_USEC", "400000", 1);
    process_ = start_pliant(words, folder_);
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
  }
  /// Of a cushion, which never leaves the picture.
  void write_config(const std::string& text) const {
    write_file(
        at("c.toml"),
        "source = \"simulated:cushion?frames=100000&width=160&height=120\"\n[lcm]\nurl = \"none\"\n" + text);
  }
  /// Has the program read its config again, as `systemctl reload` does.
  [[nodiscard]] bool reloads() {
    kill(process_, SIGHUP);
    return manager_.hears("RELOADING=1", 30'000) && manager_.hears("READY=1", 30'000);
  }
  /// Ends the program by SIGTERM; the seconds that it took.
  double end(Ended& ended) {
    const auto before = std::chrono::steady_clock::now();
    kill(process_, SIGTERM);
    ended = wait_for(process_, folder_);
    process_ = -1;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  }

  /// The program ends within a second; a busy machine is given more.
  static constexpr double kEndsWithin = 8.0;

  FakeManager manager_;
  pid_t process_ = -1;
};

TEST_F(Service, IsReadyPingsAndEndsWithinASecond) {
  write_config("");
  start({"--config", at("c.toml"), "--pace", "realtime"});
  ASSERT_TRUE(manager_.hears("READY=1", 30'000));
  EXPECT_TRUE(manager_.hears("STATUS=frame ", 30'000));
  for (int ping = 0; ping < 5; ++ping) EXPECT_TRUE(manager_.hears("WATCHDOG=1", 10'000));
  Ended ended;
  EXPECT_LT(end(ended), kEndsWithin);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(manager_.hears("STOPPING=1\nSTATUS=ended after ", 10'000));
}

TEST_F(Service, PingsStopWhenFramesStopAndItStillEndsWithinASecond) {
  const std::string recording = small_recording(6), model = box_model();
  // A frame that does not come: opening it waits until this lease is given back.
  const int lease = open((recording + "/depth/000003.png").c_str(), O_RDONLY | O_CLOEXEC);
  const auto handler = std::signal(SIGIO, SIG_IGN);  // asks for it
  if (fcntl(lease, F_SETLEASE, F_WRLCK) != 0) GTEST_SKIP() << "no file can be leased here";
  start({"--source", "recording:" + recording, "--model", model, "--lcm-url", "none"});
  ASSERT_TRUE(manager_.hears("READY=1", 30'000));
  ASSERT_TRUE(manager_.hears("STATUS=frame 3/6", 30'000));
  static_cast<void>(manager_.count("WATCHDOG=1", 500));  // the last ones
  EXPECT_EQ(manager_.count("WATCHDOG=1", 1500), 0);
  Ended ended;
  EXPECT_LT(end(ended), kEndsWithin);
  EXPECT_EQ(ended.code, 0) << ended.err;
  close(lease);
  std::signal(SIGIO, handler);
}

TEST_F(Service, AReloadKeepsTheLogAndTheNumberOfFrames) {
  const auto write = [this](int budget) {
    write_file(at("c.toml"), fmt::format("source = \"simulated:cushion?frames=100000&width=160&height=120\"\n"
                                         "[lcm]\nurl = \"file://run.log?mode=w\"\n[track]\nbudget_ms = {}\n",
                                         budget));
  };
  write_file(at("run.log"), "what was there");
  write(33);
  start({"--config", at("c.toml"), "--pace", "fast", "--frames", "1500"});
  ASSERT_TRUE(manager_.hears("  tracking", 20'000));
  write(50);
  kill(process_, SIGHUP);
  Ended ended = wait_for(process_, folder_);
  process_ = -1;
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("config read again: track.budget_ms"), std::string::npos) << ended.err;
  Result<LcmLog> log = LcmLog::open(at("run.log"));
  ASSERT_TRUE(log) << log.error().message;
  LcmLogEvent event;
  RegionsMessage message;
  std::int64_t first = -1, last = -1;
  while (log->next(event)) {
    if (event.channel != "PLIANT_REGIONS" || !decode(event.body, message)) continue;
    if (first < 0) first = message.frame;
    last = message.frame;
  }
  EXPECT_EQ(log->damages(), 0);
  EXPECT_EQ(first, 0);
  EXPECT_EQ(last, 1499);
}

TEST_F(Service, AnotherModelUnderTheSameNameIsTold) {
  const std::string model = box_model();
  write_config("");
  start({"--config", at("c.toml"), "--model", model, "--pace", "realtime"});
  ASSERT_TRUE(manager_.hears("READY=1", 30'000));
  ASSERT_EQ(run_pliant({"model", "build", "simulated:cushion", "-o", model}).code, 0);
  ASSERT_TRUE(reloads());
  EXPECT_TRUE(manager_.hears("  tracking", 30'000));
  ASSERT_TRUE(reloads());
  Ended ended;
  EXPECT_LT(end(ended), kEndsWithin);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err,
            "pliant: config read again: the model file is another\n"
            "pliant: config read again: nothing has changed\n");
}

TEST_F(Service, AnotherSensorDescriptionUnderTheSameNameIsTakenUp) {
  const auto describe = [this](double floor) {
    write_file(at("sensor.toml"), fmt::format("[noise]\nnoise_floor = {}\n", floor));
  };
  describe(0.001);
  write_config("[sensor]\ndescription = \"sensor.toml\"\n");
  // As below, no frame is dropped.
  start({"--config", at("c.toml"), "--pace", "fast"});
  ASSERT_TRUE(manager_.hears("READY=1", 30'000));
  ASSERT_TRUE(manager_.hears("  tracking", 20'000));
  describe(0.002);
  ASSERT_TRUE(reloads());
  EXPECT_TRUE(manager_.hears("  tracking", 30'000));
  ASSERT_TRUE(reloads());
  Ended ended;
  EXPECT_LT(end(ended), kEndsWithin);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err,
            "pliant: config read again: the sensor description is another\n"
            "pliant: config read again: nothing has changed\n");
  EXPECT_NE(ended.out.find("lost 0, searching 0"), std::string::npos) << ended.out;
}

TEST_F(Service, AValidConfigIsTakenUpWithoutLosingTheObject) {
  write_config("[track]\nbudget_ms = 33\n");
  // No frame is dropped, however busy the machine is: one that is lost was lost by the reload.
  start({"--config", at("c.toml"), "--pace", "fast"});
  ASSERT_TRUE(manager_.hears("READY=1", 30'000));
  ASSERT_TRUE(manager_.hears("  tracking", 20'000));
  write_config("[track]\nbudget_ms = 50\n");
  ASSERT_TRUE(reloads());
  // The very first frames of the new run are tracked: none is spent on searching.
  std::string line;
  for (int i = 0; i < 200 && line.find("STATUS=frame ") == std::string::npos; ++i)
    line = manager_.receive(50);
  EXPECT_NE(line.find("  tracking"), std::string::npos) << line;
  Ended ended;
  EXPECT_LT(end(ended), kEndsWithin);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("config read again: track.budget_ms"), std::string::npos) << ended.err;
  EXPECT_NE(ended.out.find("lost 0, searching 0"), std::string::npos) << ended.out;
}

TEST_F(Service, AWrongConfigIsRefusedAndTheOldOneStays) {
  write_config("");
  start({"--config", at("c.toml"), "--pace", "realtime"});
  ASSERT_TRUE(manager_.hears("READY=1", 30'000));
  write_config("[track]\nbudget = 50\n");
  ASSERT_TRUE(reloads());
  for (int ping = 0; ping < 3; ++ping) EXPECT_TRUE(manager_.hears("WATCHDOG=1", 10'000));
  Ended ended;
  EXPECT_LT(end(ended), kEndsWithin);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("the old config stays: "), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("c.toml:5:"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("budget_ms"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace pliant::test

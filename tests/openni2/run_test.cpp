// The program itself on the virtual sensor: what it tracks, records and says when the cable is pulled.
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "drivers/lcm/subscriber.hpp"
#include "tests/commands/program.hpp"
#include "tests/openni2/sensor_rig.hpp"

namespace pliant::test {
namespace {

class OpenNi2Run : public CommandTest {
 protected:
  /// The statuses in an LCM log of ours.
  static std::vector<StatusMessage> statuses(const std::string& log) {
    std::vector<StatusMessage> all;
    LcmSubscriber::Handlers handlers;
    handlers.status = [&all](const StatusMessage& status) { all.push_back(status); };
    auto reader = LcmSubscriber::create("file://" + log + "?speed=0", "PLIANT", handlers);
    EXPECT_TRUE(reader);
    while ((*reader)->handle(100) >= 0) {
    }
    return all;
  }
  nlohmann::json stats() const { return nlohmann::json::parse(read_file(at("s.json"))); }
  SensorRig rig_{"simulated:box?width=320&height=240&frames=60"};
};

TEST_F(OpenNi2Run, TracksTheObjectThroughTheDevice) {
  const std::string model = box_model();
  rig_.control().rate = 15;  // so that a slow machine drops none
  const Ended ended = run_pliant({"run", "--source", "openni2:", "--model", model, "--frames", "50",
                                  "--lcm-url", "file://" + at("log") + "?mode=w", "--stats", at("s.json")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_GE(stats()["tracked"].get<int>(), 40);
  EXPECT_EQ(stats()["bad_frames"], 0);
  const std::vector<StatusMessage> told = statuses(at("log"));
  ASSERT_GE(told.size(), 3U);
  EXPECT_EQ(told.back().device, DeviceState::ended);
  bool streamed = false;
  for (const StatusMessage& status : told) streamed = streamed || status.device == DeviceState::streaming;
  EXPECT_TRUE(streamed);
}

TEST_F(OpenNi2Run, SurvivesAPulledCable) {
  const std::string model = box_model();
  rig_.control().rate = 15;
  const pid_t process = start_pliant({"run", "--source", "openni2:", "--model", model, "--lcm-url",
                                      "file://" + at("log") + "?mode=w", "--stats", at("s.json")},
                                     folder_);
  const auto wait_for_frames = [this](int more) {
    const std::int32_t until = rig_.control().sent + more;
    for (int i = 0; i < 1500 && rig_.control().sent < until; ++i) usleep(10'000);
    return rig_.control().sent >= until;
  };
  EXPECT_TRUE(wait_for_frames(20));
  rig_.control().plugged = 0;
  usleep(700'000);
  rig_.control().plugged = 1;
  EXPECT_TRUE(wait_for_frames(30));
  kill(process, SIGTERM);
  const Ended ended = wait_for(process, folder_);
  EXPECT_EQ(ended.code, 0) << ended.err;
  const std::vector<StatusMessage> told = statuses(at("log"));
  std::string path;  // of the device's states
  TrackState last = TrackState::searching;
  for (const StatusMessage& status : told) {
    if (!path.ends_with(name_of(status.device))) path += std::string(" ") + name_of(status.device);
    last = status.state;
  }
  EXPECT_NE(path.find("streaming"), std::string::npos) << path;
  EXPECT_NE(path.find("lost"), std::string::npos) << path;
  EXPECT_NE(path.find("absent"), std::string::npos) << path;
  EXPECT_TRUE(path.ends_with("streaming ended")) << path;
  EXPECT_EQ(told.back().reopenings, 1);
  EXPECT_EQ(last, TrackState::tracking);
}

TEST_F(OpenNi2Run, ASlowOrBlindStreamIsNeverToldAsIfItWereGood) {
  const std::string model = box_model();
  rig_.control().rate = 15;
  const pid_t process = start_pliant(
      {"run", "--source", "openni2:", "--model", model, "--lcm-url", "file://" + at("log") + "?mode=w"},
      folder_);
  const auto wait_for_frames = [this](int more) {
    const std::int32_t until = rig_.control().sent + more;
    for (int i = 0; i < 1500 && rig_.control().sent < until; ++i) usleep(10'000);
    EXPECT_GE(rig_.control().sent, until);
  };
  wait_for_frames(30);
  rig_.control().fault = SensorFault::slow;
  wait_for_frames(14);
  rig_.control().fault = SensorFault::none;
  wait_for_frames(25);
  rig_.control().fault = SensorFault::zero;
  wait_for_frames(15);
  kill(process, SIGTERM);
  static_cast<void>(wait_for(process, folder_));

  // What a subscriber hears, in order.
  StreamFault fault = StreamFault::none;
  TrackState state = TrackState::searching;
  int slow = 0, good = 0, good_while_slow = 0;
  std::int64_t slow_frames = 0, zero_frames = 0;
  LcmSubscriber::Handlers handlers;
  handlers.status = [&](const StatusMessage& status) {
    fault = status.stream_fault;
    state = status.state;
    slow_frames = status.slow_frames;
    zero_frames = status.zero_frames;
  };
  handlers.regions = [&](const RegionsMessage& regions) {
    if (regions.state != TrackState::tracking || regions.part != 0) return;
    // A quarter of the frames leaves a quarter of the confidence; the tracker's own is 0.4 at least.
    if (regions.confidence < 0.35F) {
      ++slow;
      for (const RegionMessage& region : regions.regions) EXPECT_LT(region.confidence, 0.35F);
    } else {
      ++good;
      good_while_slow += fault == StreamFault::slow ? 1 : 0;
    }
  };
  auto reader = LcmSubscriber::create("file://" + at("log") + "?speed=0", "PLIANT", handlers);
  ASSERT_TRUE(reader);
  while ((*reader)->handle(100) >= 0) {
  }
  EXPECT_GE(slow, 4);
  EXPECT_GE(good, 30);
  EXPECT_LE(good_while_slow, 1) << "the first good one comes just before the status that says so";
  EXPECT_GE(slow_frames, 4);
  EXPECT_GE(zero_frames, 10);
  EXPECT_EQ(fault, StreamFault::zero);
  EXPECT_EQ(state, TrackState::lost) << "nothing is seen, so nothing is tracked";
}

TEST_F(OpenNi2Run, GivesUpWhenTheDeviceStaysAway) {
  const std::string model = box_model();
  rig_.control().rate = 15;
  write_file(at("c.toml"), "[sensor]\npatience_s = 0.5\n");
  const pid_t process = start_pliant({"run", "--source", "openni2:", "--config", at("c.toml"), "--model",
                                      model, "--lcm-url", "none", "--stats", at("s.json")},
                                     folder_);
  for (int i = 0; i < 1500 && rig_.control().sent < 25; ++i) usleep(10'000);
  rig_.control().plugged = 0;
  const Ended ended = wait_for(process, folder_);
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.err.find("did not come back within 0.5 s"), std::string::npos) << ended.err;
  EXPECT_GE(stats()["tracked"].get<int>(), 1);
  EXPECT_EQ(stats()["heap_calls_after_start"], 0) << "even where the device goes";
  EXPECT_EQ(stats()["page_faults_after_start"], 0);
}

TEST_F(OpenNi2Run, WithoutADeviceItSaysWhatToDo) {
  rig_.control().plugged = 0;
  expect_refused(run_pliant({"run", "--source", "openni2:", "--model", box_model(), "--lcm-url", "none"}), 3,
                 {"openni2", "no device is plugged in", "pliant devices"});
}

TEST_F(OpenNi2Run, AnOniFileIsTrackedTheSameEachTime) {
  const std::string model = box_model();
  rig_.control().rate = 20;
  rig_.record_oni(at("f.oni"), 40);
  std::string hash;
  for (int i = 0; i < 2; ++i) {
    const Ended ended = run_pliant({"run", "--source", "oni:" + at("f.oni"), "--model", model, "--lcm-url",
                                    "none", "--stats", at("s.json")});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_LE(stats()["searching"].get<int>(), 10);
    EXPECT_EQ(stats()["tracked"].get<int>() + stats()["searching"].get<int>(), 40);  // never lost
    EXPECT_EQ(stats()["dropped"], 0);
    EXPECT_EQ(stats()["heap_calls_after_start"], 0);
    EXPECT_EQ(stats()["page_faults_after_start"], 0);
    if (i == 0) hash = stats()["output_sha256"];
    EXPECT_EQ(stats()["output_sha256"], hash);
  }
  expect_refused(run_pliant({"run", "--source", "oni:" + at("none.oni"), "--model", model}), 2, {"none.oni"});
}

TEST_F(OpenNi2Run, ADeviceIsRecorded) {
  const Ended ended = run_pliant({"record", "--source", "openni2:", "--frames", "12", "-o", at("r")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(count_files(at("r/depth")), 12U);
  EXPECT_NE(read_file(at("r/camera.toml")).find("fx = 28"), std::string::npos);
}

TEST_F(OpenNi2Run, AFullDiskEndsARecordingOfADevice) {
  record_until_the_disk_is_full("openni2:");
}

}  // namespace
}  // namespace pliant::test

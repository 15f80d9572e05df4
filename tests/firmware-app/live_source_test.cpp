// The state machine of live sources, against a device that does what a test tells it.
#include "firmware-app/pipeline/live_source.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <thread>
#include <vector>

#include "firmware-app/measure/clock.hpp"

namespace pliant {
namespace {

constexpr Intrinsics kCamera{64, 48, 60, 60, 31.5, 23.5, 1000};
constexpr std::int64_t kMillisecond = 1'000'000;

/// What the device is made to do; shared by all openings of it.
struct Script {
  enum class Stream { sound, silent, lost, zero, stuck, noise, wrong_size, delayed, broken, slow };
  std::atomic<Stream> stream{Stream::sound};
  std::atomic<bool> plugged{true}, usable{true};
  std::atomic<int> openings{0}, open_now{0}, resets{0};
  std::atomic<int> width{64};
  std::atomic<int> stands_still_ms{0};  ///< once, while it is asked, with the whole program
};

class Device final : public DepthSource {
 public:
  explicit Device(Script& script) : script_(script), camera_(kCamera), pixels_(64 * 48) {
    camera_.width = script.width;
    ++script_.openings;
    ++script_.open_now;
  }
  ~Device() override { --script_.open_now; }
  [[nodiscard]] const Intrinsics& intrinsics() const override { return camera_; }
  [[nodiscard]] const SensorDescription& sensor() const override { return sensor_; }
  [[nodiscard]] bool live() const override { return true; }
  [[nodiscard]] double rate() const override { return 50; }
  [[nodiscard]] std::string place() const override { return "the port of the tests"; }
  void close() override {}
  void next(int timeout_ms, SourceItem& item) override {
    using Stream = Script::Stream;
    item.fault.clear();
    item.event = SourceEvent::timeout;
    sleep_until_ns(monotonic_ns() + script_.stands_still_ms.exchange(0) * kMillisecond);
    if (!script_.plugged || script_.stream == Stream::lost) {
      item.event = SourceEvent::lost;
      item.fault = "unplugged";
      return;
    }
    const std::int64_t until = monotonic_ns() + timeout_ms * kMillisecond;
    if (script_.stream == Stream::silent || due_ > until) {
      sleep_until_ns(until);
      return;
    }
    sleep_until_ns(due_);
    const std::int64_t period = (script_.stream == Stream::slow ? 80 : 20) * kMillisecond;
    due_ = std::max(due_ + period, monotonic_ns() - 20 * kMillisecond);
    item.event = SourceEvent::frame;
    draw();
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    std::int64_t utime = std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
    if (script_.stream == Stream::delayed && count_ > 3) utime -= 500'000;
    const int width = script_.stream == Stream::wrong_size ? 32 : 64;
    item.frame = {pixels_.data(), width, 48, 64, utime, 12345};
    if (script_.stream == Stream::broken) {
      item.event = SourceEvent::bad_frame;
      item.fault = "half a frame";
    }
  }

 private:
  void draw() {
    using Stream = Script::Stream;
    const Stream stream = script_.stream;
    if (stream != Stream::stuck || count_ == 0) ++count_;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      pixels_[i] = static_cast<std::uint16_t>(900 + i % 64 + static_cast<std::size_t>(count_) % 50);
      if (stream == Stream::zero) pixels_[i] = 0;
      if (stream == Stream::noise)
        pixels_[i] = static_cast<std::uint16_t>(((i + static_cast<std::size_t>(count_)) * 2654435761U) >> 7);
    }
  }
  Script& script_;
  Intrinsics camera_;
  SensorDescription sensor_;
  std::vector<std::uint16_t> pixels_;
  std::int64_t due_ = monotonic_ns();
  int count_ = 0;
};

struct Rig {
  Rig() {
    settings.open = [this] { return open(); };
  }
  Result<std::unique_ptr<DepthSource>> open() {
    if (!script.plugged) return Error{ErrorKind::absent, "no device is plugged in"};
    if (!script.usable) return Error{ErrorKind::device, "the device is busy"};
    return std::unique_ptr<DepthSource>(std::make_unique<Device>(script));
  }
  void start() {
    auto opened = LiveSource::open(settings);
    ASSERT_TRUE(opened) << opened.error().message;
    source = std::move(*opened);
  }
  /// Runs the source for a while; milliseconds until `state` was reached, -1 where it never was.
  std::int64_t until(DeviceState state, int most_ms) {
    const std::int64_t begin = monotonic_ns();
    while (monotonic_ns() - begin < most_ms * kMillisecond) {
      source->next(50, item);
      if (item.event == SourceEvent::frame) ++frames;
      if (item.event == SourceEvent::bad_frame) ++bad;
      if (item.event == SourceEvent::lost) break;
      if (source->monitor()->state() == state) return (monotonic_ns() - begin) / kMillisecond;
    }
    return -1;
  }
  void run(int milliseconds) {
    const std::int64_t end = monotonic_ns() + milliseconds * kMillisecond;
    while (monotonic_ns() < end) {
      source->next(20, item);
      if (item.event == SourceEvent::frame) ++frames;
      if (item.event == SourceEvent::bad_frame) ++bad;
      if (item.event == SourceEvent::lost) return;
    }
  }
  Script script;
  LiveSettings settings;
  std::unique_ptr<LiveSource> source;
  SourceItem item;
  int frames = 0, bad = 0;
};

TEST(LiveSource, OpensAndStreams) {
  Rig rig;
  rig.start();
  EXPECT_EQ(rig.source->monitor()->state(), DeviceState::opening);
  EXPECT_GE(rig.until(DeviceState::streaming, 1000), 0);
  rig.run(200);
  EXPECT_GE(rig.frames, 5);
  EXPECT_EQ(rig.item.frame.number, rig.frames - 1);  // its own count, not the device's
  EXPECT_EQ(rig.bad, 0);
  rig.source->close();
  rig.source->next(10, rig.item);
  EXPECT_EQ(rig.item.event, SourceEvent::end);
  EXPECT_EQ(rig.source->monitor()->state(), DeviceState::ended);
  EXPECT_EQ(rig.script.open_now, 0);
}

TEST(LiveSource, ADeviceThatIsNotThereIsAnErrorAtTheStart) {
  Rig rig;
  rig.script.plugged = false;
  const auto opened = LiveSource::open(rig.settings);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, ErrorKind::absent);
}

TEST(LiveSource, NoticesAStallWithinThreeFrameTimesAndItsEnd) {
  Rig rig;
  rig.start();
  rig.run(100);
  rig.script.stream = Script::Stream::silent;
  const std::int64_t stalled = rig.until(DeviceState::stalled, 1000);
  EXPECT_GE(stalled, 30);
  EXPECT_LE(stalled, 60 + 25) << "three frame times of 20 ms, and what the machine adds";
  EXPECT_NE(rig.item.fault, "");
  rig.script.stream = Script::Stream::sound;
  EXPECT_GE(rig.until(DeviceState::streaming, 300), 0);
  EXPECT_EQ(rig.source->monitor()->stalls(), 1);
  EXPECT_EQ(rig.script.openings, 1);
}

TEST(LiveSource, ASlowStreamIsPassedOnAndSaidToBeSlow) {
  Rig rig;
  rig.start();
  rig.run(300);
  EXPECT_EQ(rig.source->monitor()->rate_share(), 1);
  rig.script.stream = Script::Stream::slow;
  rig.run(700);  // more than half of the nine intervals that count
  EXPECT_EQ(rig.source->monitor()->fault(), StreamFault::slow);
  EXPECT_NEAR(rig.source->monitor()->rate_share(), 0.25, 0.06);
  EXPECT_GT(rig.source->monitor()->frames(StreamFault::slow), 0);
  EXPECT_EQ(rig.source->monitor()->state(), DeviceState::streaming);
  EXPECT_FALSE(rig.source->monitor()->blind());
  EXPECT_EQ(rig.bad, 0);
  rig.script.stream = Script::Stream::sound;
  rig.run(400);
  EXPECT_EQ(rig.source->monitor()->fault(), StreamFault::none);
  EXPECT_EQ(rig.source->monitor()->rate_share(), 1);
}

TEST(LiveSource, AProgramThatStoodStillDoesNotBlameTheDevice) {
  for (const bool while_asked : {false, true}) {
    Rig rig;
    rig.settings.patience = rig.settings.most_useless = 0.5;
    rig.settings.most_pause = 0.4;
    rig.start();
    rig.run(200);
    rig.script.stream = Script::Stream::delayed;  // what lay in the buffers
    if (while_asked)
      rig.script.stands_still_ms = 1000;
    else
      sleep_until_ns(monotonic_ns() + 1000 * kMillisecond);
    rig.source->next(20, rig.item);
    EXPECT_EQ(rig.item.event, SourceEvent::bad_frame) << rig.item.fault;
    rig.script.stream = Script::Stream::sound;
    rig.frames = 0;
    rig.run(200);
    EXPECT_NE(rig.item.event, SourceEvent::lost) << rig.item.fault;
    EXPECT_GT(rig.frames, 2);
    EXPECT_EQ(rig.script.openings, 1) << "nothing was wrong with it";
  }
}

TEST(LiveSource, IsBlindWhileNoSoundFrameComes) {
  using Stream = Script::Stream;
  Rig rig;
  rig.start();
  EXPECT_TRUE(rig.source->monitor()->blind());
  for (const Stream stream : {Stream::zero, Stream::stuck, Stream::silent, Stream::lost}) {
    rig.script.stream = Stream::sound;
    rig.run(200);
    EXPECT_FALSE(rig.source->monitor()->blind());
    rig.script.stream = stream;
    rig.run(60 + 60);  // three frame times, and what the machine adds
    EXPECT_TRUE(rig.source->monitor()->blind()) << static_cast<int>(stream);
  }
}

TEST(LiveSource, WhoKeepsFramesTakesLateOnesToo) {
  Rig rig;
  rig.settings.late_is_welcome = true;
  rig.start();
  rig.script.stream = Script::Stream::delayed;
  rig.run(400);
  EXPECT_GT(rig.frames, 5);
  EXPECT_EQ(rig.bad, 0);
  EXPECT_GT(rig.source->monitor()->frames(StreamFault::delayed), 3) << "counted all the same";
  EXPECT_EQ(rig.script.openings, 1);
}

TEST(LiveSource, ALateStartOfTheProgramIsNotTheDevicesFault) {
  Rig rig;
  rig.settings.most_useless = rig.settings.first_frame = 0.1;
  rig.settings.patience = 0.2;
  rig.start();
  sleep_until_ns(monotonic_ns() + 400 * kMillisecond);
  rig.script.stream = Script::Stream::broken;  // what waited is of no use
  rig.run(60);
  rig.script.stream = Script::Stream::sound;
  rig.run(100);
  EXPECT_EQ(rig.script.openings, 1);
  EXPECT_GT(rig.frames, 0);
}

TEST(LiveSource, OpensAStalledDeviceAgainAndResetsItAsALastResort) {
  Rig rig;
  rig.settings.most_stall = 0.1;
  rig.settings.first_frame = 0.05;
  rig.settings.reset = [&rig](const std::string& place) {
    EXPECT_EQ(place, "the port of the tests");
    ++rig.script.resets;
  };
  rig.start();
  rig.run(100);
  rig.script.stream = Script::Stream::silent;
  EXPECT_GE(rig.until(DeviceState::lost, 2000), 0);
  rig.run(700);
  EXPECT_GE(rig.script.openings, 3);
  EXPECT_EQ(rig.script.resets, 0);
  rig.run(4000);
  EXPECT_GE(rig.script.resets, 1);
  EXPECT_LE(rig.script.openings, 12) << "pauses grow";
  EXPECT_LE(rig.script.open_now, 1);
  rig.script.stream = Script::Stream::sound;
  EXPECT_GE(rig.until(DeviceState::streaming, 1500), 0);
}

TEST(LiveSource, AnUnpluggedDeviceComesBack) {
  Rig rig;
  rig.start();
  rig.run(100);
  const int before = rig.frames;
  rig.script.plugged = false;
  const std::int64_t lost = rig.until(DeviceState::lost, 1000);
  EXPECT_GE(lost, 0);
  EXPECT_LE(lost, 60);
  EXPECT_EQ(rig.item.fault, "unplugged");
  EXPECT_GE(rig.until(DeviceState::absent, 1000), 0);
  rig.run(500);
  EXPECT_EQ(rig.frames, before);
  rig.script.plugged = true;
  EXPECT_LE(rig.until(DeviceState::streaming, 2000), 1200);
  rig.run(100);
  EXPECT_GT(rig.frames, before);
  EXPECT_EQ(rig.item.frame.number, rig.frames + rig.bad - 1) << "numbers go on";
  EXPECT_EQ(rig.source->monitor()->reopenings(), 1);
}

TEST(LiveSource, AnArrivalEndsThePauseAtOnce) {
  Rig rig;
  rig.settings.arrivals = std::make_shared<ArrivalSignal>();
  rig.start();
  rig.run(60);
  rig.script.plugged = false;
  rig.run(2500);  // the pause is a second by now
  rig.script.plugged = true;
  rig.settings.arrivals->notify();
  EXPECT_LE(rig.until(DeviceState::streaming, 2000), 150);
}

TEST(LiveSource, ABusyDeviceIsReopening) {
  Rig rig;
  rig.start();
  rig.run(60);
  rig.script.usable = false;
  rig.script.stream = Script::Stream::lost;
  EXPECT_GE(rig.until(DeviceState::reopening, 1000), 0);
  EXPECT_EQ(rig.item.fault, "the device is busy");
}

TEST(LiveSource, PatienceEnds) {
  Rig rig;
  rig.settings.patience = 0.5;
  rig.start();
  rig.run(60);
  rig.script.plugged = false;
  EXPECT_EQ(rig.until(DeviceState::ended, 3000), -1);
  EXPECT_EQ(rig.item.event, SourceEvent::lost);
  EXPECT_NE(rig.item.fault.find("0.5 s"), std::string::npos) << rig.item.fault;
  EXPECT_EQ(rig.source->monitor()->state(), DeviceState::lost);
}

TEST(LiveSource, RefusesADeviceThatComesBackOtherwise) {
  Rig rig;
  rig.start();
  rig.run(60);
  rig.script.width = 32;
  rig.script.stream = Script::Stream::lost;
  EXPECT_GE(rig.until(DeviceState::reopening, 1000), 0);
  EXPECT_NE(rig.item.fault.find("another camera or mode"), std::string::npos) << rig.item.fault;
  EXPECT_EQ(rig.script.open_now, 0);
}

class Faults : public testing::TestWithParam<std::pair<Script::Stream, StreamFault>> {};

TEST_P(Faults, AreWithheldCountedAndEndWithANewOpening) {
  Rig rig;
  rig.settings.most_useless = 0.4;
  rig.start();
  rig.run(150);
  ASSERT_GT(rig.frames, 3);
  rig.script.stream = GetParam().first;
  rig.source->next(100, rig.item);  // one frame may have been on its way
  rig.frames = rig.bad = 0;
  rig.run(200);
  const StreamFault fault = GetParam().second;
  EXPECT_EQ(rig.frames, 0);
  EXPECT_GE(rig.bad, 4);
  EXPECT_EQ(rig.source->monitor()->fault(), fault);
  EXPECT_GE(rig.source->monitor()->frames(fault), 4);
  EXPECT_EQ(rig.source->monitor()->state(), DeviceState::streaming);
  EXPECT_NE(rig.item.fault, "");
  rig.run(800);
  if (fault == StreamFault::zero)
    EXPECT_EQ(rig.script.openings, 1) << "a covered camera is not opened again";
  else
    EXPECT_GE(rig.script.openings, 2);
  rig.script.stream = Script::Stream::sound;
  rig.frames = 0;
  rig.run(1500);
  EXPECT_GT(rig.frames, 0);
}

INSTANTIATE_TEST_SUITE_P(All, Faults,
                         testing::Values(std::pair{Script::Stream::zero, StreamFault::zero},
                                         std::pair{Script::Stream::stuck, StreamFault::stuck},
                                         std::pair{Script::Stream::noise, StreamFault::noise},
                                         std::pair{Script::Stream::wrong_size, StreamFault::wrong_size},
                                         std::pair{Script::Stream::delayed, StreamFault::delayed},
                                         std::pair{Script::Stream::broken, StreamFault::broken}),
                         [](const auto& about) { return name_of(about.param.second); });

}  // namespace
}  // namespace pliant

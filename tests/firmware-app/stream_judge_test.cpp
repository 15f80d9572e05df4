// Faulty streams are told from sound ones.
#include "firmware-app/pipeline/stream_judge.hpp"
#include "core/memory/row_major.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <vector>

#include "drivers/recording/recording.hpp"

namespace pliant {
namespace {

constexpr Intrinsics kCamera{320, 240, 285, 285, 159.5, 119.5, 1000};
constexpr std::int64_t kFrameNs = 33'333'333;

/// A stream of frames at 30 Hz whose content and times a test may spoil.
struct Stream {
  Stream() : judge(kCamera, {}, 30), pixels(320 * 240) { surface(); }
  /// A slanted wall with a box before it, with the sensor's noise; never twice the same.
  void surface() {
    std::normal_distribution<double> noise(0, 2);
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u) {
        const bool box = u > 100 && u < 200 && v > 60 && v < 160;
        at(u, v) = static_cast<std::uint16_t>((box ? 800 : 1200 + 2 * u + v) + noise(random));
      }
  }
  std::uint16_t& at(int u, int v) { return pixels[row_major(v, 320, u)]; }
  StreamFault next(std::int64_t delay_us = 0, std::int64_t interval_ns = kFrameNs) {
    now_ns += interval_ns;
    const DepthFrame frame{pixels.data(), 320, 240, 320, now_ns / 1000 - delay_us, 0};
    return judge.judge(frame, now_ns, now_ns / 1000);
  }
  StreamJudge judge;
  std::vector<std::uint16_t> pixels;
  std::mt19937 random{7};  // NOLINT(cert-msc51-cpp): the same in every run
  std::int64_t now_ns = 1'000'000'000'000;
};

TEST(StreamJudge, PassesASoundStream) {
  Stream stream;
  for (int i = 0; i < 30; ++i) {
    stream.surface();
    EXPECT_EQ(stream.next(), StreamFault::none) << i;
  }
  EXPECT_EQ(stream.judge.frame_time_ns(), kFrameNs);
}

TEST(StreamJudge, KnowsAFrameWithoutReadings) {
  Stream stream;
  std::fill(stream.pixels.begin(), stream.pixels.end(), std::uint16_t{0});
  EXPECT_EQ(stream.next(), StreamFault::zero);
  EXPECT_EQ(stream.next(), StreamFault::zero);
  stream.at(319, 239) = 1;  // the very last reading counts
  EXPECT_EQ(stream.next(), StreamFault::none);
}

TEST(StreamJudge, KnowsAFrameThatCameBefore) {
  Stream stream;
  EXPECT_EQ(stream.next(), StreamFault::none);
  EXPECT_EQ(stream.next(), StreamFault::stuck);
  ++stream.at(17, 3);  // one reading that is another
  EXPECT_EQ(stream.next(), StreamFault::none);
  stream.judge.restart();
  EXPECT_EQ(stream.next(), StreamFault::none);  // a new stream may begin with what the old one ended with
}

TEST(StreamJudge, KnowsNoise) {
  Stream stream;
  std::uniform_int_distribution<int> any(0, 10000), narrow(600, 1600), salt(0, 30);
  for (std::uint16_t& z : stream.pixels) z = static_cast<std::uint16_t>(any(stream.random));
  EXPECT_EQ(stream.next(), StreamFault::noise);
  for (std::uint16_t& z : stream.pixels) z = static_cast<std::uint16_t>(narrow(stream.random));
  EXPECT_EQ(stream.next(), StreamFault::noise);
  for (std::uint16_t& z : stream.pixels) z = salt(stream.random) == 0 ? std::uint16_t{900} : std::uint16_t{0};
  EXPECT_EQ(stream.next(), StreamFault::noise);
  // A surface of which a tenth is noise is still one.
  std::uniform_int_distribution<int> tenth(0, 9);
  stream.surface();
  for (std::uint16_t& z : stream.pixels)
    if (tenth(stream.random) == 0) z = static_cast<std::uint16_t>(any(stream.random));
  EXPECT_EQ(stream.next(), StreamFault::none);
}

TEST(StreamJudge, KnowsAnotherSize) {
  Stream stream;
  const DepthFrame frame{stream.pixels.data(), 160, 120, 160, 0, 0};
  EXPECT_EQ(stream.judge.judge(frame, 1, 1), StreamFault::wrong_size);
}

TEST(StreamJudge, KnowsAFrameThatCameLate) {
  Stream stream;
  constexpr std::int64_t kUsual = 20'000;  // µs from the shutter to the program
  for (int i = 0; i < 10; ++i) {
    stream.surface();
    ASSERT_EQ(stream.next(kUsual + 1000 * (i % 5)), StreamFault::none);
  }
  stream.surface();
  EXPECT_EQ(stream.next(kUsual + 60'000), StreamFault::none);  // within three frame times
  stream.surface();
  EXPECT_EQ(stream.next(kUsual + 110'000), StreamFault::delayed);
  stream.surface();
  EXPECT_EQ(stream.next(kUsual), StreamFault::none);
}

TEST(StreamJudge, KnowsAStreamThatIsLateFromItsFirstFrame) {
  Stream stream;
  for (int i = 0; i < 10; ++i) {
    stream.surface();
    EXPECT_EQ(stream.next(199'000), StreamFault::none) << "six frame times are what buffers may hold";
  }
  for (const std::int64_t age : {201'000, 250'000, 1'000'000}) {
    stream.judge.restart();
    for (int i = 0; i < 10; ++i) {
      stream.surface();
      EXPECT_EQ(stream.next(age), StreamFault::delayed);
    }
  }
}

TEST(StreamJudge, KnowsASlowStreamAndWaitsLongerForIt) {
  Stream stream;
  const auto next = [&](std::int64_t interval) {
    stream.surface();
    return stream.next(0, interval);
  };
  for (int i = 0; i < 12; ++i) ASSERT_EQ(next(kFrameNs), StreamFault::none);
  EXPECT_EQ(stream.judge.rate_share(), 1);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(next(4 * kFrameNs), StreamFault::none) << "a hiccup of four frames";
  for (int i = 0; i < 6; ++i) static_cast<void>(next(3 * kFrameNs));
  EXPECT_EQ(next(3 * kFrameNs), StreamFault::slow);
  EXPECT_EQ(stream.judge.frame_time_ns(), 3 * kFrameNs);
  EXPECT_FLOAT_EQ(stream.judge.rate_share(), 1.0F / 3);
  for (int i = 0; i < 6; ++i) static_cast<void>(next(kFrameNs));
  EXPECT_EQ(next(kFrameNs), StreamFault::none);
  EXPECT_EQ(stream.judge.rate_share(), 1);
}

TEST(StreamJudge, TakesNoRealFrameForNoise) {
  const std::filesystem::path shared = PLIANT_SHARED_DATA;
  if (!std::filesystem::is_directory(shared)) GTEST_SKIP() << "the shared recordings are not here";
  int recordings = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shared)) {
    if (!std::filesystem::exists(entry.path() / "depth.txt")) continue;
    auto source = open_recording(entry.path());
    if (!source) continue;  // of another kind
    ++recordings;
    StreamJudge judge((*source)->intrinsics(), (*source)->sensor(), 30);
    SourceItem item;
    std::int64_t now = 0;
    for (int i = 0; i < 40; ++i) {
      (*source)->next(10000, item);
      if (item.event == SourceEvent::end) break;
      if (item.event != SourceEvent::frame) continue;
      now += kFrameNs;
      item.frame.utime = now / 1000;
      EXPECT_NE(judge.judge(item.frame, now, now / 1000), StreamFault::noise)
          << entry.path() << " frame " << item.frame.number;
    }
  }
  EXPECT_GE(recordings, 3);
}

}  // namespace
}  // namespace pliant

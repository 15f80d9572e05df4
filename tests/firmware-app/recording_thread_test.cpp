// The queue between a device and the disk.
#include "firmware-app/pipeline/recording_thread.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "drivers/recording/depth_list.hpp"
#include "drivers/simulated/simulated.hpp"
#include "firmware-app/measure/clock.hpp"
#include "tests/temporary_folder.hpp"

namespace pliant {
namespace {

class Recording : public testing::Test {
 protected:
  Recording() {
    auto made = RecordingWriter::create(folder_ / "r", {kCamera, {}});
    EXPECT_TRUE(made);
    writer_ = std::move(*made);
  }
  static constexpr Intrinsics kCamera{640, 480, 570, 570, 320, 240, 1000};
  const test::TemporaryFolder folder_;
  std::unique_ptr<RecordingWriter> writer_;
};

TEST_F(Recording, WhatTheDiskHasNoTimeForIsDroppedAndCounted) {
  RecordingThread thread(*writer_, kCamera);
  std::vector<std::uint16_t> pixels(640 * 480);
  std::int64_t most = 0;
  for (int i = 0; i < 60; ++i) {
    std::uint32_t random = static_cast<std::uint32_t>(i) + 1;  // noise packs badly
    for (std::uint16_t& z : pixels) {
      random = random * 1664525 + 1013904223;
      z = static_cast<std::uint16_t>(random >> 16);
    }
    const std::int64_t begin = monotonic_ns();
    thread.push({pixels.data(), 640, 480, 640, i * 1000, i});
    most = std::max(most, monotonic_ns() - begin);
  }
  EXPECT_TRUE(thread.finish());
  EXPECT_GT(thread.dropped(), 0);
  EXPECT_GE(thread.written(), static_cast<std::int64_t>(RecordingThread::kSlots));
  EXPECT_EQ(thread.dropped() + thread.written(), 60);
  EXPECT_LT(most, 300'000'000) << "a push waits for no disk";
  const auto listed = read_depth_list(folder_ / "r");
  ASSERT_TRUE(listed);
  EXPECT_EQ(static_cast<std::int64_t>(listed->size()), thread.written());
}

TEST_F(Recording, KeepsThePaceOfASensorWithoutADrop) {
  auto source = open_simulated("simulated:cushion?frames=6");
  ASSERT_TRUE(source);
  std::vector<std::vector<std::uint16_t>> frames;
  SourceItem item;
  for (int i = 0; i < 6; ++i) {
    (*source)->next(1000, item);
    frames.emplace_back(item.frame.depth, item.frame.depth + 640 * 480);
  }
  RecordingThread thread(*writer_, kCamera);
  const std::int64_t begin = monotonic_ns();
  for (int i = 0; i < 45; ++i) {
    sleep_until_ns(begin + i * std::int64_t{33'333'333});
    thread.push({frames[static_cast<std::size_t>(i % 6)].data(), 640, 480, 640, i * 33'333, i});
  }
  EXPECT_TRUE(thread.finish());
  EXPECT_EQ(thread.dropped(), 0);
  EXPECT_EQ(thread.written(), 45);
  RecordProperty("milliseconds_a_frame_at_most", static_cast<int>((monotonic_ns() - begin) / 45 / 1'000'000));
}

TEST_F(Recording, AFailedWriteIsToldAndEndsTheWriting) {
  RecordingThread thread(*writer_, kCamera);
  std::filesystem::remove_all(folder_ / "r" / "depth");
  std::vector<std::uint16_t> pixels(640 * 480, 900);
  for (int i = 0; i < 5; ++i) thread.push({pixels.data(), 640, 480, 640, i, i});
  const Outcome end = thread.finish();
  ASSERT_FALSE(end);
  EXPECT_EQ(end.error().kind, ErrorKind::write);
  EXPECT_EQ(thread.written(), 0);
  EXPECT_EQ(thread.dropped(), 5);
}

}  // namespace
}  // namespace pliant

// Reads recordings as a user hands them over, whole and broken.
#include "drivers/recording/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "drivers/images/png.hpp"
#include "tests/temporary_folder.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class RecordingTest : public testing::Test {
 protected:
  static constexpr int kWidth = 64, kHeight = 48;

  void SetUp() override {
    fs::create_directories(folder_ / "depth");
    put("camera.toml", "width = 64\nheight = 48\nfx = 60\nfy = 60\ncx = 32\ncy = 24\ndepth_scale = 1000\n");
  }

  void put(const char* name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] static std::string file_of(int i) { return "depth/" + std::to_string(i) + ".png"; }
  /// Every pixel of picture i is 100 + i.
  void put_picture(int i, int width = kWidth) const {
    const std::vector<std::uint16_t> pixels(static_cast<std::size_t>(width) * kHeight,
                                            static_cast<std::uint16_t>(100 + i));
    ASSERT_TRUE(write_png_grey16(folder_ / file_of(i), {pixels.data(), width, kHeight, width}));
  }
  void put_all(int count) const {
    std::string list = "# seconds file\n";
    for (int i = 0; i < count; ++i) {
      put_picture(i);
      list += std::to_string(i) + ".5 " + file_of(i) + "\n";
    }
    put("depth.txt", list);
  }
  [[nodiscard]] std::string fault() const {
    const auto source = open_recording(folder_);
    if (source) return "opened";
    EXPECT_EQ(source.error().kind, ErrorKind::bad_input);
    return source.error().message;
  }
  [[nodiscard]] std::vector<SourceEvent> events() const {
    std::vector<SourceEvent> all;
    auto source = open_recording(folder_);
    if (!source) return all;
    SourceItem item;
    do {
      (*source)->next(5000, item);
      all.push_back(item.event);
    } while (item.event != SourceEvent::end && all.size() < 1000);
    return all;
  }

  const test::TemporaryFolder made_;
  fs::path folder_ = made_.path();
};

TEST_F(RecordingTest, DeliversEveryFrameInOrder) {
  put_all(20);
  auto source = open_recording(folder_);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_FALSE((*source)->live());
  EXPECT_EQ((*source)->frame_count(), 20);
  EXPECT_EQ((*source)->intrinsics().width, kWidth);
  SourceItem item;
  for (int i = 0; i < 20; ++i) {
    (*source)->next(5000, item);
    ASSERT_EQ(item.event, SourceEvent::frame) << item.fault;
    EXPECT_EQ(item.frame.number, i);
    EXPECT_EQ(item.frame.utime, i * std::int64_t{1000000} + 500000);
    EXPECT_EQ(item.frame.width, kWidth);
    EXPECT_EQ(item.frame.height, kHeight);
    const std::uint16_t* d = item.frame.depth;
    EXPECT_TRUE(
        std::all_of(d, d + std::ptrdiff_t{kWidth} * kHeight, [&](std::uint16_t p) { return p == 100 + i; }));
  }
  for (int i = 0; i < 3; ++i) {
    (*source)->next(5000, item);
    EXPECT_EQ(item.event, SourceEvent::end);
  }
}

TEST_F(RecordingTest, BorrowedFrameStaysUntilTheNextCall) {
  put_all(10);
  auto source = open_recording(folder_);
  ASSERT_TRUE(source);
  SourceItem item;
  (*source)->next(5000, item);
  ASSERT_EQ(item.event, SourceEvent::frame);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the decoder runs as far ahead as it may
  EXPECT_EQ(item.frame.depth[0], 100);
  EXPECT_EQ(item.frame.depth[kWidth * kHeight - 1], 100);
}

TEST_F(RecordingTest, CloseInTheMiddleEndsIt) {
  put_all(10);
  auto source = open_recording(folder_);
  ASSERT_TRUE(source);
  SourceItem item;
  (*source)->next(5000, item);
  (*source)->close();
  (*source)->next(5000, item);
  EXPECT_EQ(item.event, SourceEvent::end);
  (*source)->close();
}

TEST_F(RecordingTest, OneBadFrameIsSkippedAndKeepsItsNumber) {
  put_all(7);
  fs::remove(folder_ / file_of(1));
  fs::resize_file(folder_ / file_of(3), fs::file_size(folder_ / file_of(3)) / 2);
  put_picture(5, kWidth / 2);
  auto source = open_recording(folder_);
  ASSERT_TRUE(source) << source.error().message;
  SourceItem item;
  for (int i = 0; i < 7; ++i) {
    (*source)->next(5000, item);
    EXPECT_EQ(item.frame.number, i);
    EXPECT_EQ(item.frame.utime, i * std::int64_t{1000000} + 500000);
    const bool bad = i == 1 || i == 3 || i == 5;
    EXPECT_EQ(item.event, bad ? SourceEvent::bad_frame : SourceEvent::frame) << i;
    EXPECT_EQ(item.fault.empty(), !bad);
    EXPECT_EQ(item.frame.depth == nullptr, bad);
    if (bad) {
      EXPECT_NE(item.fault.find(file_of(i)), std::string::npos) << item.fault;
    }
    if (i == 5) {
      EXPECT_NE(item.fault.find("32x48 pixels; camera.toml says 64x48"), std::string::npos);
    }
  }
}

TEST_F(RecordingTest, AllFramesBadStillEnds) {
  put_all(4);
  fs::remove_all(folder_ / "depth");
  using enum SourceEvent;
  EXPECT_EQ(events(), (std::vector<SourceEvent>{bad_frame, bad_frame, bad_frame, bad_frame, end}));
}

TEST_F(RecordingTest, WhatIsMissingOrMalformedIsNamed) {
  EXPECT_EQ(fault(), folder_.string() +
                         ": holds no depth.txt; a recording is a folder with camera.toml and depth.txt");
  put("depth.txt", "0 depth/0.png\nnonsense\n");
  EXPECT_EQ(fault().rfind((folder_ / "depth.txt").string() + ":2: ", 0), 0U) << fault();
  put("depth.txt", "");
  EXPECT_NE(fault().find("lists no frame"), std::string::npos);
  put_all(1);
  put("camera.toml", "width = 64\nheigth = 48\n");
  EXPECT_NE(fault().find("camera.toml:2:1: unknown key 'heigth'; nearest known key is 'height'"),
            std::string::npos)
      << fault();
  fs::remove(folder_ / "camera.toml");
  EXPECT_EQ(fault(), folder_.string() +
                         ": holds no camera.toml; a recording is a folder with camera.toml and depth.txt");
  fs::remove_all(folder_);
  EXPECT_EQ(fault(), folder_.string() + ": no such recording");
  std::ofstream(folder_).flush();
  EXPECT_NE(fault().find("not a folder"), std::string::npos);
}

TEST_F(RecordingTest, ReadsTheRealRecording) {
  const fs::path real = fs::path(PLIANT_SHARED_DATA) / "real_plush_squirrel";
  if (!fs::exists(real)) GTEST_SKIP() << "no shared data beside the repository";
  auto source = open_recording(real);
  ASSERT_TRUE(source) << source.error().message;
  SourceItem item;
  int frames = 0;
  for ((*source)->next(5000, item); item.event == SourceEvent::frame; (*source)->next(5000, item)) {
    EXPECT_EQ(item.frame.number, frames);
    ASSERT_EQ(item.frame.utime, (frames * std::int64_t{1000000} + 15) / 30);
    const std::uint16_t* d = item.frame.depth;
    EXPECT_GT(std::count_if(d, d + std::ptrdiff_t{320} * 240, [](std::uint16_t p) { return p > 0; }), 20000);
    ++frames;
  }
  EXPECT_EQ(item.event, SourceEvent::end) << item.fault;
  EXPECT_EQ(frames, 480);
}

}  // namespace
}  // namespace pliant

#include "drivers/recording/recording_writer.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "drivers/recording/recording.hpp"
#include "drivers/recording/text_file.hpp"
#include "tests/temporary_folder.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class RecordingWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    camera_.intrinsics = {40, 30, 50, 51, 20, 15, 8000};
    camera_.sensor.noise_floor = 0.0007;
    pixels_.resize(std::size_t{50} * 30);
  }

  /// A frame with gaps between its rows.
  DepthFrame frame(int i) {
    for (std::size_t p = 0; p < pixels_.size(); ++p)
      pixels_[p] = static_cast<std::uint16_t>(p + 1000 * static_cast<std::size_t>(i));
    return {pixels_.data(), 40, 30, 50, 1305031102175304 + i * std::int64_t{33333}, std::int64_t{7} * i};
  }
  [[nodiscard]] std::string text(const char* name) const {
    const Result<std::string> text = read_text_file(folder_ / name, 1 << 20);
    return text ? *text : text.error().message;
  }

  const test::TemporaryFolder made_;
  fs::path folder_ = made_ / "recording";
  CameraFile camera_;
  std::vector<std::uint16_t> pixels_;
};

TEST_F(RecordingWriterTest, WhatIsWrittenReadsBackAtAnyTime) {
  auto writer = RecordingWriter::create(folder_ / "deep" / "er", camera_);
  ASSERT_TRUE(writer) << writer.error().message;
  for (int i = 0; i < 3; ++i) {
    const Outcome written = (*writer)->write(frame(i));
    ASSERT_TRUE(written) << written.error().message;
    auto source = open_recording(folder_ / "deep" / "er");  // the writer is still at work
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->frame_count(), i + 1);
    EXPECT_EQ((*source)->intrinsics().depth_scale, 8000);
    EXPECT_EQ((*source)->sensor().noise_floor, 0.0007);
    SourceItem item;
    for (int k = 0; k <= i; ++k) {
      (*source)->next(5000, item);
      ASSERT_EQ(item.event, SourceEvent::frame) << item.fault;
      EXPECT_EQ(item.frame.number, k);
      EXPECT_EQ(item.frame.utime, 1305031102175304 + k * std::int64_t{33333});
      EXPECT_EQ(item.frame.depth[41], static_cast<std::uint16_t>(51 + 1000 * k));
    }
  }
  EXPECT_EQ((*writer)->frames(), 3);
  EXPECT_TRUE((*writer)->finish());
  EXPECT_TRUE((*writer)->finish());
  EXPECT_FALSE((*writer)->write(frame(4)));
}

TEST_F(RecordingWriterTest, TruthIsWrittenAsTumLines) {
  auto writer = RecordingWriter::create(folder_, camera_);
  ASSERT_TRUE(writer);
  EXPECT_FALSE(fs::exists(folder_ / "groundtruth.txt"));
  RigidTransform pose;
  pose.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  pose.translation << 0.1, -0.25, 0.8;
  ASSERT_TRUE((*writer)->write_truth(1033333, pose));
  EXPECT_EQ(text("groundtruth.txt"),
            "# seconds tx ty tz qx qy qz qw\n"
            "1.033333 0.100000 -0.250000 0.800000 0.0000000 0.0000000 0.7071068 0.7071068\n");
}

TEST_F(RecordingWriterTest, DoesNotWriteOverARecording) {
  {
    auto writer = RecordingWriter::create(folder_, camera_);
    ASSERT_TRUE(writer);
    ASSERT_TRUE((*writer)->write(frame(0)));
  }
  const auto second = RecordingWriter::create(folder_, camera_);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::bad_input);
  EXPECT_NE(second.error().message.find("already holds"), std::string::npos);
}

TEST_F(RecordingWriterTest, FailuresAreTyped) {
  const auto nowhere = RecordingWriter::create("/proc/nowhere", camera_);
  ASSERT_FALSE(nowhere);
  EXPECT_EQ(nowhere.error().kind, ErrorKind::write);
  auto writer = RecordingWriter::create(folder_, camera_);
  ASSERT_TRUE(writer);
  DepthFrame wrong = frame(0);
  wrong.width = 39;
  EXPECT_FALSE((*writer)->write(wrong));
  fs::remove_all(folder_ / "depth");
  const Outcome lost = (*writer)->write(frame(0));
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().kind, ErrorKind::write);
  EXPECT_NE(lost.error().message.find("000000.png"), std::string::npos);
  EXPECT_EQ(text("depth.txt"), "# seconds file\n");
}

}  // namespace
}  // namespace pliant

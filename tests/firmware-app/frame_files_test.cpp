#include "firmware-app/outputs/frame_files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "tests/temporary_folder.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class FrameFilesTest : public testing::Test {
 protected:
  FrameFilesTest() {
    result_.state = TrackState::tracking;
    result_.regions = {&region_, 1};
    result_.positions = rest_;
    result_.labels = labels_;
    result_.matches = matches_;
    result_.residuals = residuals_;
  }

  const test::TemporaryFolder made_;
  fs::path folder_ = made_.path();
  std::vector<Point3f> rest_ = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0.1F, 0}};
  std::vector<std::int8_t> labels_ = {0, kDeformed, kNotObserved};
  std::vector<std::int32_t> matches_ = {7, -1, -1};
  std::vector<float> residuals_ = {0.001F, 0, 0};
  Region region_;
  TrackResult result_;
};

TEST_F(FrameFilesTest, WritesTrackedFramesOnly) {
  const FrameFilesSettings settings{(folder_ / "t.txt").string(), (folder_ / "points").string(), true};
  Result<std::unique_ptr<FrameFiles>> files = FrameFiles::create(settings, rest_);
  ASSERT_TRUE(files) << files.error().message;
  for (int i = 0; i < 40; ++i) {
    result_.frame = i;
    result_.utime = 1'500'000'000'000'000 + i * 33'333;
    result_.state = i % 4 == 3 ? TrackState::lost : TrackState::tracking;
    result_.pose.translation = Vector3(0.5, -0.25, i);
    (*files)->submit(result_);
  }
  ASSERT_TRUE((*files)->finish());
  EXPECT_TRUE(fs::exists(folder_ / "points/000000.ply"));
  EXPECT_FALSE(fs::exists(folder_ / "points/000003.ply"));
  EXPECT_TRUE(fs::exists(folder_ / "points/000038.ply"));
  int files_there = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_ / "points")) ++files_there;
  EXPECT_EQ(files_there, 30);

  std::ifstream trajectory(folder_ / "t.txt");
  std::string line;
  int lines = 0;
  while (std::getline(trajectory, line)) {
    if (lines == 1) {
      EXPECT_EQ(line, "1500000000.033333 0.5 -0.25 1 0 0 0 1");
    }
    ++lines;
  }
  EXPECT_EQ(lines, 30);
}

TEST_F(FrameFilesTest, AFolderThatTakesNoFileIsRefusedAtTheStart) {
  // Nobody, not even root, can make a file there.
  const Result<std::unique_ptr<FrameFiles>> files = FrameFiles::create({"", "/proc/self", true}, rest_);
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().kind, ErrorKind::write);
  EXPECT_NE(files.error().message.find("/proc/self/"), std::string::npos) << files.error().message;
}

TEST_F(FrameFilesTest, ATrajectoryGrowsByWholeLines) {
  const std::string path = (folder_ / "t.txt").string();
  const auto text = [&path] {
    std::ostringstream all;
    all << std::ifstream(path).rdbuf();
    return all.str();
  };
  Result<TrajectoryWriter> writer = TrajectoryWriter::create(path, TrajectoryWriter::Appears::by_lines);
  ASSERT_TRUE(writer) << writer.error().message;
  ASSERT_TRUE(writer->write(1'000'000, RigidTransform{}));
  const std::string line = "1.000000 0 0 0 0 0 0 1\n";
  EXPECT_EQ(text(), line) << "it can be followed";
  // A limit of the file's size cuts a write off in its middle, as a full disk does.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little{line.size() + 5, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);
  const Outcome refused = writer->write(1'000'000, RigidTransform{});
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::write);
  EXPECT_TRUE(writer->finish());
  EXPECT_EQ(text(), line);
}

TEST_F(FrameFilesTest, FrameWithoutItsBaseRegionHasNoTrajectoryLine) {
  const FrameFilesSettings settings{(folder_ / "t.txt").string(), "", true};
  Result<std::unique_ptr<FrameFiles>> files = FrameFiles::create(settings, rest_);
  ASSERT_TRUE(files);
  region_.id = 1;
  (*files)->submit(result_);
  ASSERT_TRUE((*files)->finish());
  EXPECT_EQ(fs::file_size(folder_ / "t.txt"), 0U);
}

TEST_F(FrameFilesTest, AFolderThatHoldsPointsIsRefused) {
  std::ofstream(folder_ / "000123.ply") << "ply";
  const Result<std::unique_ptr<FrameFiles>> files = FrameFiles::create({"", folder_.string(), true}, rest_);
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().kind, ErrorKind::bad_input);
  EXPECT_NE(files.error().message.find("000123.ply"), std::string::npos);
}

TEST_F(FrameFilesTest, OtherFilesInTheFolderDoNotMatter) {
  std::ofstream(folder_ / "notes.txt") << "hello";
  std::ofstream(folder_ / "cloud.ply") << "ply";
  EXPECT_TRUE(FrameFiles::create({"", folder_.string(), true}, rest_));
}

TEST_F(FrameFilesTest, UnwritablePlacesAreWriteErrors) {
  std::ofstream(folder_ / "file") << "x";
  const Result<std::unique_ptr<FrameFiles>> points =
      FrameFiles::create({"", (folder_ / "file/points").string(), true}, rest_);
  ASSERT_FALSE(points);
  EXPECT_EQ(points.error().kind, ErrorKind::write);
  const Result<std::unique_ptr<FrameFiles>> trajectory =
      FrameFiles::create({(folder_ / "none/t.txt").string(), "", true}, rest_);
  ASSERT_FALSE(trajectory);
  EXPECT_EQ(trajectory.error().kind, ErrorKind::write);
}

TEST_F(FrameFilesTest, AFullDiskIsToldAndDoesNotBlock) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  Result<std::unique_ptr<FrameFiles>> files = FrameFiles::create({"/dev/full", "", true}, rest_);
  ASSERT_TRUE(files);
  for (int i = 0; i < 1000; ++i) (*files)->submit(result_);
  const Outcome finished = (*files)->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().kind, ErrorKind::write);
  EXPECT_NE(finished.error().message.find("No space left"), std::string::npos) << finished.error().message;
}

}  // namespace
}  // namespace pliant

// pliant record.
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

using RecordCommand = CommandTest;

TEST_F(RecordCommand, WritesARecordingWithItsTruth) {
  const std::string folder = small_recording(3);
  for (const char* name : {"camera.toml", "depth.txt", "depth/000000.png", "depth/000002.png",
                           "groundtruth.txt", "model.ply", "truth/000002.ply", "truth/poses.txt"})
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(folder) / name)) << name;
  EXPECT_FALSE(std::filesystem::exists(folder + "/depth/000003.png"));
}

TEST_F(RecordCommand, ARecordingOfARecordingHasTheSameFrames) {
  const std::string first = small_recording(3);
  const Ended ended = run_pliant({"record", "--source", "recording:" + first, "-o", at("second")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* name : {"camera.toml", "depth.txt", "depth/000000.png", "depth/000002.png"})
    EXPECT_EQ(read_file(std::filesystem::path(first) / name), read_file(folder_ / "second" / name)) << name;
}

TEST_F(RecordCommand, FramesLimitsTheNumber) {
  const Ended ended = run_pliant(
      {"record", "--source", "simulated:box?width=160&height=120", "-o", at("r"), "--frames", "2"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(count_files(folder_ / "r/depth"), 2U);
}

TEST_F(RecordCommand, AFolderThatHoldsARecordingIsRefused) {
  const std::string folder = small_recording(1);
  expect_refused(run_pliant({"record", "--source", "simulated:box", "-o", folder}), 2, {folder});
}

TEST_F(RecordCommand, AnUnwritablePlaceIsAWriteFailure) {
  write_file(at("file"), "x");
  expect_refused(run_pliant({"record", "--source", "simulated:box", "-o", at("file/r")}), 3, {"file/r"});
}

}  // namespace
}  // namespace pliant::test

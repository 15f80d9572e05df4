// pliant record.
#include "drivers/lcm/depth_messages.hpp"
#include "drivers/lcm/lcm_log_writer.hpp"
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

TEST_F(RecordCommand, TheSensorsDescriptionWinsOverTheSource) {
  write_file(at("sensor.toml"), "[noise]\nnoise_floor = 0.0123\n");
  const std::string first = small_recording(2);
  const std::string sources[] = {"recording:" + first, "simulated:box?width=160&height=120&frames=2"};
  for (const std::string& source : sources) {
    std::filesystem::remove_all(at("second"));
    const Ended ended =
        run_pliant({"record", "--source", source, "--sensor", at("sensor.toml"), "-o", at("second")});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(read_file(at("second/camera.toml")).find("0.0123"), std::string::npos) << source;
  }
}

TEST_F(RecordCommand, AFolderThatHoldsARecordingIsRefused) {
  const std::string folder = small_recording(1);
  expect_refused(run_pliant({"record", "--source", "simulated:box", "-o", folder}), 2, {folder});
}

TEST_F(RecordCommand, AnEmptyPlaceIsNotTheCurrentOne) {
  expect_refused(run_pliant({"record", "--source", "simulated:box", "--frames", "1", "-o", ""}), 2,
                 {"names no folder"});
}

TEST_F(RecordCommand, AnUnwritablePlaceIsAWriteFailure) {
  write_file(at("file"), "x");
  expect_refused(run_pliant({"record", "--source", "simulated:box", "-o", at("file/r")}), 3, {"file/r"});
}

TEST_F(RecordCommand, AFullDiskEndsItWithAWholeRecording) {
  record_until_the_disk_is_full("simulated:box?width=320&height=240&frames=200");
}

TEST_F(RecordCommand, AnLcmLogWithDepthIsASourceLikeTheOneItCameFrom) {
  const std::string source = "simulated:box?width=320&height=240&frames=40";
  const Ended first = run_pliant({"run", "--source", source, "--publish-depth", "--lcm-url",
                                  "file://" + at("log") + "?mode=w", "--stats", at("first.json")});
  ASSERT_EQ(first.code, 0) << first.err;
  const Ended again = run_pliant({"run", "--source", "lcmlog:" + at("log"), "--model", box_model(),
                                  "--lcm-url", "none", "--stats", at("again.json")});
  ASSERT_EQ(again.code, 0) << again.err;
  const auto hash = [this](const char* name) {
    const std::string stats = read_file(at(name));
    return stats.substr(stats.find("output_sha256"), 90);
  };
  EXPECT_NE(read_file(at("again.json")).find("\"frames\": 40"), std::string::npos);
  EXPECT_EQ(hash("first.json"), hash("again.json"));
  expect_refused(run_pliant({"run", "--source", "lcmlog:" + at("again.json"), "--model", box_model()}), 2,
                 {"again.json", "not an LCM log"});
}

TEST_F(RecordCommand, AFrameWhoseStampNoRecordingCanHoldIsABadFrame) {
  const Intrinsics camera{32, 24, 30, 30, 15.5, 11.5, 1000};
  std::vector<std::uint16_t> pixels(std::size_t{32} * 24, 800);
  Result<std::unique_ptr<LcmLogWriter>> log = LcmLogWriter::open(at("log"), false);
  ASSERT_TRUE(log) << log.error().message;
  DepthMessages messages(32, 24);
  constexpr std::int64_t kMost = 10'000'000'000'000'000;  // microseconds
  for (const std::int64_t utime : {std::int64_t{0}, std::int64_t{-1'500'000}, kMost, kMost + 1}) {
    ++pixels[0];
    for (const MessageBody& body : messages.encode({pixels.data(), 32, 24, 32, utime, 0}, camera))
      ASSERT_TRUE((*log)->write("PLIANT_DEPTH", body.bytes));
  }
  Ended ended = run_pliant({"record", "--source", "lcmlog:" + at("log"), "-o", at("r")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("recorded 2 frames"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("left out 2 bad ones (the last: frame 3 "), std::string::npos) << ended.out;
  // What was written can be read again.
  ended = run_pliant({"record", "--source", "recording:" + at("r"), "-o", at("again")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(read_file(at("again/depth.txt")), read_file(at("r/depth.txt")));
}

}  // namespace
}  // namespace pliant::test

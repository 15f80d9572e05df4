// What pliant run refuses, and how it says so.
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "drivers/images/png.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

using RunRefusals = CommandTest;

TEST_F(RunRefusals, SaysWhatIsMissing) {
  expect_refused(run_pliant({"run"}), 2, {"no source", "--source"});
  expect_refused(run_pliant({"run", "--source", "recording:" + small_recording(1)}), 2,
                 {"no model", "--model"});
}

TEST_F(RunRefusals, UnknownSourcesNameTheKnownOnes) {
  for (const char* source : {"laser:0", "nonsense"})
    expect_refused(run_pliant({"run", "--source", source}), 2,
                   {source, "recording:DIR", "openni2:", "v4l2:", "simulated:"});
  expect_refused(run_pliant({"run", "--source", "oni:x.oni"}), 2, {"x.oni", "No such file"});
  expect_refused(run_pliant({"run", "--source", "v4l2:/dev/video0"}), 2, {"--sensor"});
  expect_refused(run_pliant({"run", "--source", "v4l2:/dev/video0?format=RGB"}), 2, {"format=RGB", "Z16"});
  expect_refused(run_pliant({"run", "--source", folder_.string()}), 2, {"recording:" + folder_.string()});
  expect_refused(run_pliant({"run", "--source", "simulated:cushoin"}), 2, {"cushoin"});
  expect_refused(run_pliant({"run", "--source", "simulated:box?sed=2"}), 2, {"sed"});
}

TEST_F(RunRefusals, WhatIsNoFileIsNotWaitedFor) {
  const std::string pipe = at("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string sensor = PLIANT_CONFIG_FOLDER "/sensors/realsense_d435.toml";
  const auto refuses = [&sensor](const std::string& source, const std::vector<std::string>& parts) {
    expect_refused(run_pliant({"run", "--source", source, "--sensor", sensor}), 2, parts);
  };
  for (const char* scheme : {"oni:", "lcmlog:"}) {
    refuses(scheme + pipe, {pipe, "a device or a pipe"});
    refuses(std::string(scheme) + "/dev/zero", {"/dev/zero", "a device or a pipe"});
    refuses(scheme, {scheme, "names no file"});
  }
  for (const std::string& path : {pipe, std::string("/dev/null"), std::string("/dev/zero"), folder_.string()})
    refuses("v4l2:" + path, {path, "is no video device"});
}

TEST_F(RunRefusals, MissingFilesAreNamed) {
  expect_refused(run_pliant({"run", "--source", "recording:" + at("none"), "--model", at("none.model")}), 2,
                 {at("none")});
  expect_refused(run_pliant({"run", "--source", "simulated:box", "--model", at("none.model")}), 2,
                 {"none.model"});
  expect_refused(run_pliant({"run", "--config", at("none.toml")}), 2, {"none.toml"});
}

TEST_F(RunRefusals, BadConfigsNameThePlace) {
  write_file(at("p.toml"), "source = \"simulated:box\"\n[lcm]\nurll = \"none\"\n");
  expect_refused(run_pliant({"run", "--config", at("p.toml")}), 2, {at("p.toml") + ":3:1:", "lcm.url"});
  write_file(at("p.toml"), "source = \"simulated:box\"\n[run]\nthreads = 0\n");
  expect_refused(run_pliant({"run", "--config", at("p.toml")}), 2, {at("p.toml") + ":3:11:", "1 to 64"});
}

TEST_F(RunRefusals, BadLcmUrlsAreRefused) {
  expect_refused(run_pliant({"run", "--source", "simulated:box", "--lcm-url", "udpm://1.2.3.4:1"}), 2,
                 {"1.2.3.4"});
  expect_refused(run_pliant({"run", "--source", "simulated:box", "--lcm-url", "bogus"}), 2, {"bogus"});
}

TEST_F(RunRefusals, ALogThatTheDiskHasNoRoomForIsAWriteFailure) {
  expect_refused(run_pliant({"run", "--source", "simulated:box?frames=3&width=160&height=120", "--lcm-url",
                             "file:///dev/full?mode=w", "--stats", at("s.json")}),
                 3, {"/dev/full", "No space left on device", "free some space"});
  const nlohmann::json stats = nlohmann::json::parse(read_file(at("s.json")));
  EXPECT_GT(stats["send_failures"].get<int>(), 3);
}

TEST_F(RunRefusals, ListeningNeverWritesALog) {
  write_file(at("run.log"), "what was there");
  expect_refused(
      run_pliant({"snapshot", "--lcm-url", "file://" + at("run.log") + "?mode=w", "-o", at("a.png")}), 2,
      {"run.log", "use ?mode=r"});
  EXPECT_EQ(read_file(at("run.log")), "what was there");
}

TEST_F(RunRefusals, AWrongLogCostsNoFileWhatItHolds) {
  for (const auto& [url, code] : {std::pair{"file://" + at("x.log"), 2},
                                  {"file://" + at("none/x.log") + "?mode=w", 3},
                                  {"file://" + folder_.string() + "?mode=w", 3}}) {
    write_file(at("t.txt"), "what was there");
    expect_refused(run_pliant({"run", "--source", "simulated:box?frames=3&width=160&height=120", "--lcm-url",
                               url, "--trajectory", at("t.txt")}),
                   code, {"LCM"});
    EXPECT_EQ(read_file(at("t.txt")), "what was there");
  }
}

TEST_F(RunRefusals, AFolderThatHoldsPointsIsRefused) {
  std::filesystem::create_directories(at("points"));
  write_file(at("points/000007.ply"), "ply\n");
  expect_refused(run_pliant({"run", "--source", "simulated:box?frames=2&width=160&height=120", "--lcm-url",
                             "none", "--points", at("points")}),
                 2, {"points", "000007.ply"});
  EXPECT_EQ(read_file(at("points/000007.ply")), "ply\n");
}

TEST_F(RunRefusals, UnwritableOutputsAreWriteFailures) {
  const std::vector<std::string> run = {"run", "--source", "simulated:box?frames=2&width=160&height=120",
                                        "--lcm-url", "none"};
  for (const auto& [option, path] :
       {std::pair{"--stats", "no/s.json"}, {"--trajectory", "no/t.txt"}, {"--points", "file/p"}}) {
    write_file(at("file"), "x");
    std::vector<std::string> words = run;
    words.insert(words.end(), {option, at(path)});
    expect_refused(run_pliant(words), 3, {path});
  }
}

TEST_F(RunRefusals, AFullDiskIsAWriteFailure) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Ended ended = run_pliant({"run", "--source", "simulated:cushion?frames=40&width=320&height=240",
                                  "--lcm-url", "none", "--trajectory", "/dev/full"});
  expect_refused(ended, 3, {"/dev/full", "No space left"});
}

TEST_F(RunRefusals, BadFramesAreSkippedAndCounted) {
  const std::string recording = small_recording(6);
  const std::string model = box_model();
  const std::filesystem::path depth = std::filesystem::path(recording) / "depth";
  const std::string whole = read_file(depth / "000001.png");
  write_file(depth / "000001.png", whole.substr(0, whole.size() / 2));  // cut short
  const std::vector<std::uint16_t> pixels(80 * 60, 700);
  ASSERT_TRUE(write_png_grey16(depth / "000003.png", {pixels.data(), 80, 60, 80}));  // of another size
  std::filesystem::remove(depth / "000004.png");                                     // missing
  std::filesystem::remove(depth / "000005.png");
  ASSERT_EQ(mkfifo((depth / "000005.png").c_str(), 0600), 0);  // would never come
  const Ended ended = run_pliant({"run", "--source", "recording:" + recording, "--model", model, "--lcm-url",
                                  "none", "--stats", at("s.json")});
  EXPECT_TRUE(ended.code == 0 || ended.code == 1) << ended.code << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_NE(ended.out.find("bad 4"), std::string::npos) << ended.out;
  const std::string stats = read_file(at("s.json"));
  EXPECT_NE(stats.find("\"frames\": 2"), std::string::npos) << stats;
  EXPECT_NE(stats.find("\"bad_frames\": 4"), std::string::npos) << stats;
}

TEST_F(RunRefusals, WithoutAUsableFrameTheInputIsBad) {
  const std::string recording = small_recording(2);
  const std::string model = box_model();
  for (const char* name : {"000000.png", "000001.png"})
    write_file(std::filesystem::path(recording) / "depth" / name, "no picture");
  expect_refused(
      run_pliant({"run", "--source", "recording:" + recording, "--model", model, "--lcm-url", "none"}), 2,
      {"no frame is usable", "000001.png"});
}

}  // namespace
}  // namespace pliant::test

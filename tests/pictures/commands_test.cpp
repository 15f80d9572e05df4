// pliant plot and pliant snapshot, as a user runs them.
#include <gtest/gtest.h>

#include "drivers/images/png.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

class PictureCommands : public CommandTest {
 protected:
  void track() const {
    write_file(at("depth.toml"), "[lcm]\npublish_depth = true\n");
    const Ended record = run_pliant(
        {"record", "--source", "simulated:cushion?width=320&height=240&frames=60", "-o", at("recording")});
    ASSERT_EQ(record.code, 0) << record.err;
    const Ended run =
        run_pliant({"run", "--source", "simulated:cushion?width=320&height=240&frames=60", "--config",
                    at("depth.toml"), "--lcm-url", "file://" + at("run.log") + "?mode=w", "--stats",
                    at("stats.json"), "--trajectory", at("path.txt")});
    ASSERT_EQ(run.code, 0) << run.err;
  }
  /// Width and height of a PNG.
  static std::pair<int, int> size_of(const std::string& png) {
    const auto number = [&](std::size_t i) {
      int value = 0;
      for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(png.at(i + k));
      return value;
    };
    return {number(16), number(20)};
  }
};

TEST_F(PictureCommands, PlotAndSnapshotDrawARun) {
  track();
  const Ended plot = run_pliant(
      {"plot", at("stats.json"), "--trajectory", at("path.txt"), "--truth", at("recording/groundtruth.txt")});
  ASSERT_EQ(plot.code, 0) << plot.err;
  const std::string svg = read_file(at("stats.svg"));
  for (const char* words : {"<svg xmlns", ">surface<", ">latency<", "60 frames: ", "position error: median",
                            "angle error: median", "<polyline", "</svg>"})
    EXPECT_NE(svg.find(words), std::string::npos) << words;

  const Ended first = run_pliant({"snapshot", "--log", at("run.log"), "-o", at("first.png"), "--frame", "0"});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("frame 0: searching"), std::string::npos) << first.out;
  const Ended last = run_pliant({"snapshot", "--log", at("run.log"), "-o", at("last.png")});
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_NE(last.out.find("frame 59: tracking"), std::string::npos) << last.out;
  const std::string png = read_file(at("last.png"));
  EXPECT_EQ(size_of(png), std::pair(320, 240)) << "the camera's own size, since depth is in the log";
}

TEST_F(PictureCommands, APlotIsUtf8WhateverItsFilesName) {
  const Ended run = run_pliant({"run", "--source", "simulated:box?frames=3&width=160&height=120", "--lcm-url",
                                "none", "--stats", at("a\xff\xc3\xa4<.json")});
  ASSERT_NE(run.code, 2) << run.err;
  ASSERT_EQ(run_pliant({"plot", at("a\xff\xc3\xa4<.json"), "-o", at("a.svg")}).code, 0);
  const std::string svg = read_file(at("a.svg"));
  EXPECT_NE(svg.find("a?\xc3\xa4&lt;.json"), std::string::npos) << svg.substr(0, 600);
  EXPECT_EQ(svg.find('\xff'), std::string::npos);
}

TEST_F(PictureCommands, WhatCannotBeDrawnIsRefusedInOneLine) {
  write_file(at("empty.json"), "{}");
  write_file(at("broken.json"), "{\"stages\": ");
  expect_refused(run_pliant({"plot", at("empty.json")}), 2, {"empty.json", "run --stats"});
  expect_refused(run_pliant({"plot", at("broken.json")}), 2, {"broken.json"});
  expect_refused(run_pliant({"plot", at("none.json")}), 2, {"none.json", "No such file"});
  expect_refused(run_pliant({"plot", at("empty.json"), "--truth", at("x")}), 2, {"--trajectory"});
  expect_refused(run_pliant({"snapshot", "--log", at("empty.json"), "-o", at("x.png")}), 2,
                 {"not an LCM log"});
  expect_refused(run_pliant({"snapshot", "-o", at("x.png"), "--lcm-url", "memq://", "--wait", "0.2"}), 2,
                 {"nothing is published on PLIANT_*", "pliant run"});
}

}  // namespace
}  // namespace pliant::test

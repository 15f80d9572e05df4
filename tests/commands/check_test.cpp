// pliant check.
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

using CheckCommand = CommandTest;

TEST_F(CheckCommand, ShowsMemoryAndTimeOfAValidConfig) {
  write_file(at("p.toml"), "source = \"simulated:cushion\"\n[track]\nbudget_ms = 20\n");
  const Ended ended = run_pliant({"check", "--config", at("p.toml")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_NE(ended.out.find("workspace"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("20 ms for a frame"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("is valid"), std::string::npos);
}

TEST_F(CheckCommand, NamesThePlaceOfAFault) {
  const std::string path = at("p.toml");
  write_file(path, "[track]\nmax_region = 3\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {path + ":2:1:", "track.max_regions"});
  write_file(path, "[track]\nmax_regions = 30\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {path + ":2:15:", "1 to 8"});
  write_file(path, "[track\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {path + ":1:"});
  expect_refused(run_pliant({"check", "--config", at("none.toml")}), 2, {"none.toml"});
  expect_refused(run_pliant({"check", "--config", folder_.string()}), 2, {});
}

TEST_F(CheckCommand, ADeviceThatIsNotThereIsNoFaultOfTheConfig) {
  const std::string path = at("p.toml"), model = box_model();
  write_file(
      at("sensor.toml"),
      "[mode]\nwidth = 320\nheight = 240\nrate = 60\n[camera]\nfx = 285\nfy = 285\ncx = 160\ncy = 120\n");
  write_file(path, "source = \"v4l2:/dev/video250\"\nmodel = \"" + model +
                       "\"\n[sensor]\ndescription = \"sensor.toml\"\n");
  const Ended ended = run_pliant({"check", "--config", path});
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const char* line :
       {"camera: 320x240, from the sensor's description", "memory, MB: ", "one comes every 16.7 ms",
        "device: cannot be used now: v4l2: /dev/video250", "is valid"})
    EXPECT_NE(ended.out.find(line), std::string::npos) << line << "\n" << ended.out;
  // A camera of V4L2 does not tell where its pixels look: without a description it is a fault.
  write_file(path, "source = \"v4l2:/dev/video250\"\nmodel = \"" + model + "\"\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {"sensor description"});
}

TEST_F(CheckCommand, OpensWhatTheConfigNames) {
  const std::string path = at("p.toml");
  write_file(path, "model = \"none.model\"\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {"none.model"});
  write_file(path, "source = \"recording:none\"\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {at("none")});
  write_file(path, "source = \"laser:0\"\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {"laser:0", "recording:DIR"});
  write_file(path, "[sensor]\ndescription = \"none.toml\"\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {"none.toml"});
  write_file(path, "[lcm]\nurl = \"smoke://signals\"\n");
  expect_refused(run_pliant({"check", "--config", path}), 2, {"smoke"});
}

}  // namespace
}  // namespace pliant::test

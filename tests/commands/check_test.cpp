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

TEST_F(CheckCommand, RefusesWhatARunOrTheViewerWould) {
  const std::string path = at("p.toml");
  const auto refuses = [&](const std::string& text, int code, std::vector<std::string> parts) {
    write_file(path, "source = \"simulated:box?frames=2&width=160&height=120\"\n" + text);
    expect_refused(run_pliant({"check", "--config", path}), code, parts);
    parts.erase(parts.begin());  // the place
    if (text.find("[view]") != std::string::npos)
      expect_refused(run_pliant({"view", "--config", path}), code, parts);
    else
      expect_refused(run_pliant({"run", "--config", path}), code, parts);
  };
  refuses("[lcm]\nurl = \"file://x.log\"\n", 2,
          {path + ":3:7: lcm.url: ", path + ":3:7: lcm.url: ", "?mode=w"});
  refuses("[lcm]\nurl = \"smoke://x\"\n", 2, {path + ":3:7: lcm.url: ", path + ":3:7: lcm.url: ", "smoke"});
  refuses("[lcm]\nprefix = \"A B\"\n", 2,
          {path + ":3:10: lcm.prefix: ", path + ":3:10: lcm.prefix: ", "A B"});
  refuses("[lcm]\nurl = \"file:///nodir/x?mode=w\"\n", 3,
          {path + ":3:7: ", "/nodir/x", "No such file or directory"});
  for (const char* bind : {"999.1.1.1", "1.2.3", "::g", "a b"})
    refuses("[view]\nbind = \"" + std::string(bind) + "\"\n", 2,
            {path + ":3:8: view.bind: ", path + ":3:8: view.bind: ", bind});
  write_file(at("big.obj"), "v 0 0 0\nv 4.5 0 0\nv 4.5 2 0\nv 0 0 1.5\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  ASSERT_EQ(run_pliant({"model", "build", at("big.obj"), "-o", at("big.model")}).code, 0);
  refuses("model = \"big.model\"\n", 2,
          {path + ":2:9: model: ", "the tracker cannot start: the model is larger than 4 m"});
  const Ended info = run_pliant({"model", "info", at("big.model")});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("larger than 4 m"), std::string::npos) << info.out;
  EXPECT_EQ(info.out.find("memory to track it"), std::string::npos) << info.out;
}

TEST_F(CheckCommand, LeavesALogAsItIs) {
  write_file(at("log"), "mine");
  write_file(at("p.toml"), "source = \"simulated:box\"\n[lcm]\nurl = \"file://" + at("log") + "?mode=w\"\n");
  EXPECT_EQ(run_pliant({"check", "--config", at("p.toml")}).code, 0);
  EXPECT_EQ(read_file(at("log")), "mine");
  write_file(at("p.toml"), "source = \"simulated:box\"\n[lcm]\nurl = \"file://" + at("new") +
                               "?mode=w\"\n[view]\nbind = \"board-1.local\"\n");
  EXPECT_EQ(run_pliant({"check", "--config", at("p.toml")}).code, 0);
  EXPECT_FALSE(std::filesystem::exists(at("new")));
}

}  // namespace
}  // namespace pliant::test

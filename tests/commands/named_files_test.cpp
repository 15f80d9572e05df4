// No output is written over what another option names.
#include <sys/stat.h>
#include <unistd.h>

#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

constexpr const char* kSource = "simulated:box?frames=3&width=160&height=120";

class NamedFilesTest : public CommandTest {
 protected:
  /// The command is refused with a line that holds `parts`, and `file` keeps what is in it.
  static void expect_kept(const std::string& file, const std::vector<std::string>& words,
                          std::vector<std::string> parts) {
    const std::string before = read_file(file);
    parts.push_back(file);
    expect_refused(run_pliant(words), 2, parts);
    EXPECT_EQ(read_file(file), before) << file;
  }
  [[nodiscard]] static std::vector<std::string> run_with(std::vector<std::string> more) {
    more.insert(more.begin(), {"run", "--lcm-url", "none"});
    return more;
  }
  [[nodiscard]] std::string small_file(const std::string& name) const {
    write_file(at(name), "v 0 0 0\nv 0.3 0 0\nv 0 0.2 0\nf 1 2 3\n");
    return at(name);
  }
};

TEST_F(NamedFilesTest, RunKeepsWhatItReads) {
  const std::string model = box_model(), recording = small_recording(2), source = "recording:" + recording;
  for (const char* option : {"--stats", "--trajectory", "--points"})
    expect_kept(model, run_with({"--source", source, "--model", model, option, model}), {"--model", option});
  for (const char* name : {"groundtruth.txt", "depth.txt", "camera.toml", "depth/000001.png", "model.ply"})
    for (const char* option : {"--stats", "--trajectory"})
      expect_kept(recording + "/" + name,
                  run_with({"--source", source, "--model", model, option, recording + "/" + name}),
                  {option, "--source", "recording"});
  // A file that is new does no harm there, nor does a folder.
  std::filesystem::create_directories(recording + "/points");
  const Ended beside = run_pliant(run_with({"--source", source, "--model", model, "--trajectory",
                                            recording + "/path.txt", "--points", recording + "/points"}));
  EXPECT_TRUE(beside.code == 0 || beside.code == 1) << beside.err;
  write_file(at("p.toml"), "source = \"recording:recording\"\nmodel = \"box.model\"\n");
  expect_kept(at("p.toml"), run_with({"--config", at("p.toml"), "--stats", at("p.toml")}),
              {"--stats", "--config"});
  expect_kept(model, run_with({"--config", at("p.toml"), "--stats", model}),
              {"--stats", "'model' in the config"});
}

TEST_F(NamedFilesTest, RunGivesEachOutputItsOwnPlace) {
  const std::string out = at("out");
  expect_refused(run_pliant(run_with({"--source", kSource, "--stats", out, "--trajectory", out})), 2,
                 {"--stats", "--trajectory", out});
  expect_refused(
      run_pliant(run_with({"--source", kSource, "--stats", out, "--trajectory", at("./x/../out")})), 2,
      {"--stats", "--trajectory"});
  EXPECT_FALSE(std::filesystem::exists(out));
  const Ended ended =
      run_pliant(run_with({"--source", kSource, "--stats", "/dev/null", "--trajectory", "/dev/null"}));
  EXPECT_TRUE(ended.code == 0 || ended.code == 1) << ended.err;
  EXPECT_EQ(ended.err, "");
}

TEST_F(NamedFilesTest, OtherNamesOfAFileAreFound) {
  const std::string model = box_model();
  ASSERT_EQ(symlink(model.c_str(), at("link").c_str()), 0);
  ASSERT_EQ(link(model.c_str(), at("twin").c_str()), 0);
  for (const char* name : {"link", "twin"})
    expect_kept(at(name), run_with({"--source", kSource, "--model", model, "--stats", at(name)}),
                {"--stats", "--model"});
}

TEST_F(NamedFilesTest, ALogIsNotPlayedOntoItself) {
  const std::string log = at("log"), url = "file://" + log + "?mode=w";
  ASSERT_EQ(run_pliant({"run", "--source", kSource, "--publish-depth", "--lcm-url", url}).err, "");
  expect_kept(log, {"run", "--source", "lcmlog:" + log, "--model", box_model(), "--lcm-url", url},
              {"--source", "--lcm-url"});
  write_file(at("p.toml"),
             "source = \"lcmlog:" + log + "\"\nmodel = \"box.model\"\n[lcm]\nurl = \"" + url + "\"\n");
  for (const char* command : {"run", "check"})
    expect_kept(log, {command, "--config", at("p.toml")},
                {"'source' in the config", "'lcm.url' in the config"});
  expect_kept(log, run_with({"--source", "lcmlog:" + log, "--model", at("box.model"), "--stats", log}),
              {"--source", "--stats"});
  for (const char* option : {"--tum", "--mcap", "--ply", "--csv"})
    expect_kept(log, {"export", log, option, log}, {"LOG", option});
  std::filesystem::create_directories(at("tables"));
  std::filesystem::copy_file(log, at("tables/frames.csv"));
  expect_kept(at("tables/frames.csv"), {"export", at("tables/frames.csv"), "--csv", at("tables")},
              {"LOG", "--csv"});
  expect_refused(run_pliant({"export", log, "--tum", at("s"), "--mcap", at("s")}), 2, {"--tum", "--mcap"});
  expect_kept(log, {"snapshot", "--log", log, "-o", log}, {"--log", "--output"});
}

TEST_F(NamedFilesTest, ModelsKeepTheirInputs) {
  const std::string model = box_model();
  const std::string mesh = small_file("a.obj");
  expect_kept(mesh, {"model", "build", mesh, "-o", mesh}, {"INPUT", "--output"});
  expect_kept(model, {"model", "export", model, "-o", model}, {"FILE", "--output"});
  const std::string recording = small_recording(1), camera = recording + "/camera.toml",
                    picture = recording + "/depth/000000.png";
  const std::string out = at("v");
  const std::vector<std::string> capture = {"model", "capture", picture, "--camera", camera};
  const auto with = [&capture](const std::vector<std::string>& more) {
    std::vector<std::string> words = capture;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expect_refused(run_pliant(with({"-o", out, "--ply", out})), 2, {"--output", "--ply", out});
  expect_kept(picture, with({"-o", picture}), {"--output", "VIEWS"});
  expect_kept(camera, with({"-o", camera}), {"--output", "--camera"});
  write_file(at("poses"), "0 0 0 1 0 0 0 1\n");
  expect_kept(at("poses"), with({"-o", at("m"), "--ply", at("poses"), "--poses", at("poses")}),
              {"--ply", "--poses"});
  expect_kept(camera, {"model", "capture", "--source", "recording:" + recording, "-o", camera},
              {"--output", "--source"});
}

TEST_F(NamedFilesTest, RegisterKeepsSceneModelAndCamera) {
  const std::string model = box_model();
  ASSERT_EQ(run_pliant({"model", "export", model, "-o", at("sc.ply")}).code, 0);
  const std::string scene = at("sc.ply");
  const std::vector<std::string> words = {"register", "--model", model, "--scene", scene};
  const auto with = [&words](const std::vector<std::string>& more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_kept(model, with({"-o", model}), {"--output", "--model"});
  expect_kept(scene, with({"-o", scene}), {"--output", "--scene"});
  expect_refused(run_pliant(with({"-o", at("x.ply"), "--report", at("x.ply")})), 2, {"--output", "--report"});
  expect_refused(run_pliant(with({"-o", at("x.ply"), "--report", at("x.1.ply")})), 2,
                 {"--output", "--report", "x.1.ply"});
  const std::string recording = small_recording(1), camera = recording + "/camera.toml";
  expect_kept(camera,
              {"register", "--model", model, "--scene", recording + "/depth/000000.png", "--camera", camera,
               "-o", camera},
              {"--output", "--camera"});
}

TEST_F(NamedFilesTest, PlotKeepsTheFigures) {
  ASSERT_EQ(run_pliant(run_with({"--source", kSource, "--stats", at("s.json")})).err, "");
  expect_kept(at("s.json"), {"plot", at("s.json"), "-o", at("s.json")}, {"STATS", "--output"});
  std::filesystem::rename(at("s.json"), at("s.svg"));
  expect_kept(at("s.svg"), {"plot", at("s.svg")}, {"STATS"});
}

}  // namespace
}  // namespace pliant::test

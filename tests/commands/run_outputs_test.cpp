// What pliant run leaves behind.
#include <nlohmann/json.hpp>

#include "drivers/geometry_files/geometry.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

using RunOutputs = CommandTest;

constexpr const char* kSource = "simulated:cushion?frames=40&width=320&height=240";

nlohmann::json stats_of(const std::string& path) {
  return nlohmann::json::parse(read_file(path));
}

TEST_F(RunOutputs, TracksAndWritesEverything) {
  const Ended ended = run_pliant({"run", "--source", kSource, "--lcm-url", "none", "--stats", at("s.json"),
                                  "--trajectory", at("t.txt"), "--points", at("points")});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  for (const char* word : {"frames", "tracked", "rate", "total", "memory"})
    EXPECT_NE(ended.out.find(word), std::string::npos) << ended.out;

  const nlohmann::json stats = stats_of(at("s.json"));
  EXPECT_EQ(stats["frames"], 40);
  EXPECT_EQ(stats["frames"].get<int>(),
            stats["tracked"].get<int>() + stats["lost"].get<int>() + stats["searching"].get<int>());
  EXPECT_EQ(stats["dropped"], 0);
  EXPECT_GE(stats["tracked"].get<int>(), 30);
  EXPECT_EQ(stats["output_sha256"].get<std::string>().size(), 64U);
  // Null in a build with a sanitizer, which brings a heap of its own.
  if (!stats["heap_calls_after_start"].is_null()) {
    EXPECT_EQ(stats["heap_calls_after_start"], 0);
  }
  EXPECT_GT(stats["workspace_bytes"].get<std::int64_t>(), 100'000);
  EXPECT_GT(stats["rss_bytes"].get<std::int64_t>(), stats["workspace_bytes"].get<std::int64_t>());
  EXPECT_GT(stats["stages"]["total"]["median_us"].get<double>(), 0);

  const auto tracked = stats["tracked"].get<std::size_t>();
  EXPECT_EQ(count_files(at("points")), tracked);
  const std::string trajectory = read_file(at("t.txt"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(trajectory.begin(), trajectory.end(), '\n')), tracked);
  EXPECT_TRUE(std::filesystem::exists(at("points/000039.ply")));
  const Result<Geometry> points = read_geometry(at("points/000039.ply"));
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_GT(points->vertices.size(), 1000U);
}

TEST_F(RunOutputs, FilesDoNotChangeWhatIsSaid) {
  ASSERT_EQ(run_pliant({"run", "--source", kSource, "--lcm-url", "none", "--stats", at("a.json")}).code, 0);
  ASSERT_EQ(run_pliant({"run", "--source", kSource, "--lcm-url", "none", "--stats", at("b.json"), "--points",
                        at("points"), "--trajectory", at("t.txt"), "--threads", "2"})
                .code,
            0);
  EXPECT_EQ(stats_of(at("a.json"))["output_sha256"], stats_of(at("b.json"))["output_sha256"]);
}

TEST_F(RunOutputs, EveryKernelGivesTheSame) {
  std::string expected;
  for (const char* kernels : {"scalar", "auto", "sse", "avx2", "neon"}) {
    const Ended ended = run_pliant({"run", "--source", kSource, "--frames", "20", "--lcm-url", "none",
                                    "--kernels", kernels, "--stats", at("s.json")});
    EXPECT_EQ(ended.code, 0) << kernels << ended.err;
    const std::string hash = stats_of(at("s.json"))["output_sha256"];
    if (expected.empty()) expected = hash;
    EXPECT_EQ(hash, expected) << kernels;
  }
}

TEST_F(RunOutputs, ARecordingGivesTheSameAsItsSource) {
  ASSERT_EQ(run_pliant({"record", "--source", kSource, "-o", at("r")}).code, 0);
  ASSERT_EQ(run_pliant({"model", "build", "simulated:cushion", "-o", at("m")}).code, 0);
  ASSERT_EQ(run_pliant({"run", "--source", kSource, "--lcm-url", "none", "--stats", at("a.json")}).code, 0);
  const Ended ended = run_pliant({"run", "--source", "recording:" + at("r"), "--model", at("m"), "--lcm-url",
                                  "none", "--stats", at("b.json")});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(stats_of(at("a.json"))["output_sha256"], stats_of(at("b.json"))["output_sha256"]);
}

TEST_F(RunOutputs, TheCommandLineWinsOverTheConfig) {
  write_file(at("p.toml"), "source = \"recording:none\"\nmodel = \"none.model\"\n[lcm]\nurl = \"bogus\"\n");
  const std::string model = box_model();
  const Ended ended =
      run_pliant({"run", "--config", at("p.toml"), "--source", "simulated:box?frames=3&width=160&height=120",
                  "--model", model, "--lcm-url", "none", "--stats", at("s.json")});
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(stats_of(at("s.json"))["frames"], 3);
}

TEST_F(RunOutputs, FramesLimitsTheNumber) {
  const Ended ended =
      run_pliant({"run", "--source", kSource, "--frames", "7", "--lcm-url", "none", "--stats", at("s.json")});
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(stats_of(at("s.json"))["frames"], 7);
}

TEST_F(RunOutputs, AnObjectThatIsNotThereIsNotFound) {
  const std::string model = box_model();
  const Ended ended = run_pliant({"run", "--source", kSource, "--model", model, "--lcm-url", "none",
                                  "--frames", "12", "--points", at("points"), "--trajectory", at("t.txt")});
  EXPECT_EQ(ended.code, 1) << ended.out << ended.err;
  EXPECT_EQ(count_files(at("points")), 0U);
  EXPECT_EQ(read_file(at("t.txt")), "");
}

TEST_F(RunOutputs, MessagesGoIntoALogFile) {
  const Ended ended =
      run_pliant({"run", "--source", kSource, "--lcm-url", "file://" + at("log.lcm") + "?mode=w"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_GT(std::filesystem::file_size(at("log.lcm")), 40U * 3000U);
  EXPECT_NE(ended.out.find("LCM"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find(" 0 frames unsent, 0 refused"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace pliant::test

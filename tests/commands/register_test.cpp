// pliant register.
#include <nlohmann/json.hpp>

#include "drivers/geometry_files/geometry.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

class RegisterCommand : public CommandTest {
 protected:
  /// A recording of the cushion at rest, and its model.
  void prepare() {
    ASSERT_EQ(run_pliant({"record", "--source", "simulated:cushion?frames=1&noise=none&width=320&height=240",
                          "-o", at("cushion")})
                  .code,
              0);
    ASSERT_EQ(run_pliant({"model", "build", "simulated:cushion", "-o", at("cushion.model")}).code, 0);
  }
};

TEST_F(RegisterCommand, FindsTheModelInADepthPicture) {
  prepare();
  const Ended ended = run_pliant({"register", "--model", at("cushion.model"), "--scene",
                                  at("cushion/depth/000000.png"), "--camera", at("cushion/camera.toml"), "-o",
                                  at("result.ply"), "--report", at("report.json")});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const nlohmann::json report = nlohmann::json::parse(read_file(at("report.json")));
  EXPECT_TRUE(report["found"].get<bool>());
  for (const char* stage :
       {"normals", "keypoints", "descriptors", "matching", "grouping", "chain", "deformed", "total"})
    EXPECT_TRUE(report["timing_ms"].contains(stage)) << stage;
  EXPECT_TRUE(report["keypoints"].contains("model"));
  EXPECT_TRUE(report["keypoints"].contains("scene"));
  ASSERT_EQ(report["instances"].size(), 1U);
  const nlohmann::json& base = report["instances"][0]["regions"][0];
  EXPECT_EQ(base["id"], 0);
  // The recording's own truth: "<seconds> tx ty tz qx qy qz qw" behind the comments.
  std::istringstream truth(read_file(at("cushion/groundtruth.txt")));
  std::string line;
  while (std::getline(truth, line) && line.starts_with("#")) {
  }
  std::istringstream words(line);
  double stamp = 0, t[3] = {};
  words >> stamp >> t[0] >> t[1] >> t[2];
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(base["transform"][static_cast<std::size_t>(i)][3].get<double>(), t[i], 0.01) << line;
  EXPECT_TRUE(std::filesystem::exists(at("result.ply")));
}

TEST_F(RegisterCommand, FindsTheModelInACloudOfItself) {
  prepare();
  ASSERT_EQ(run_pliant({"model", "export", at("cushion.model"), "-o", at("scene.ply")}).code, 0);
  const Ended ended = run_pliant({"register", "--model", at("cushion.model"), "--scene", at("scene.ply"),
                                  "-o", at("result.ply"), "--report", at("report.json"), "--keypoints",
                                  "500,600", "--max-regions", "2", "--threads", "2"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const nlohmann::json report = nlohmann::json::parse(read_file(at("report.json")));
  EXPECT_EQ(report["keypoints"]["model"], 500);
  const nlohmann::json& transform = report["instances"][0]["regions"][0]["transform"];
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_NEAR(transform[r][c].get<double>(), r == c ? 1.0 : 0.0, 0.01) << r << c;
}

TEST_F(RegisterCommand, AnyNumberOfThreadsGivesTheSameBytes) {
  prepare();
  ASSERT_EQ(run_pliant({"model", "export", at("cushion.model"), "-o", at("scene.ply")}).code, 0);
  for (const char* threads : {"1", "3", "16"})
    ASSERT_EQ(run_pliant({"register", "--model", at("cushion.model"), "--scene", at("scene.ply"), "-o",
                          at(std::string("result") + threads + ".ply"), "--keypoints", "500,600", "--threads",
                          threads})
                  .code,
              0);
  EXPECT_EQ(read_file(at("result1.ply")), read_file(at("result3.ply")));
  EXPECT_EQ(read_file(at("result1.ply")), read_file(at("result16.ply")));
}

TEST_F(RegisterCommand, InstancesOfAnEarlierRunDoNotStayBesideTheNewOnes) {
  prepare();
  ASSERT_EQ(run_pliant({"model", "export", at("cushion.model"), "-o", at("scene.ply")}).code, 0);
  const std::vector<std::string> words = {"register",    "--model",         at("cushion.model"),
                                          "--scene",     at("scene.ply"),   "-o",
                                          at("res.ply"), "--max-instances", "3"};
  ASSERT_EQ(run_pliant(words).code, 0);
  ASSERT_FALSE(std::filesystem::exists(at("res.1.ply")));
  std::filesystem::copy_file(at("res.ply"), at("res.1.ply"));
  std::filesystem::copy_file(at("res.ply"), at("res.5.ply"));
  write_file(at("res.2.ply"), "mine");
  ASSERT_EQ(run_pliant(words).code, 0);
  EXPECT_TRUE(std::filesystem::exists(at("res.ply")));
  EXPECT_FALSE(std::filesystem::exists(at("res.1.ply")));
  EXPECT_FALSE(std::filesystem::exists(at("res.5.ply")));
  EXPECT_EQ(read_file(at("res.2.ply")), "mine");
}

TEST_F(RegisterCommand, WhatIsNotThereIsNotFound) {
  prepare();
  write_file(at("result.ply"), "mine");
  // A few hundred points of a gently bent sheet, many times as large as a cushion's details.
  std::string cloud =
      "ply\nformat ascii 1.0\nelement vertex 900\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  for (int i = 0; i < 900; ++i) {
    const double x = (i % 30) * 0.01, y = (i / 30) * 0.01;
    cloud += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(0.3 * x * y) + "\n";
  }
  write_file(at("sheet.ply"), cloud);
  const Ended ended = run_pliant({"register", "--model", at("cushion.model"), "--scene", at("sheet.ply"),
                                  "-o", at("result.ply"), "--report", at("report.json")});
  expect_refused(ended, 1, {"sheet.ply"});
  EXPECT_EQ(read_file(at("result.ply")), "mine");  // writes none and removes none
  const nlohmann::json report = nlohmann::json::parse(read_file(at("report.json")));
  EXPECT_FALSE(report["found"].get<bool>());
  EXPECT_TRUE(report["instances"].empty());
}

TEST_F(RegisterCommand, BadInputsAreRefused) {
  prepare();
  const std::string model = at("cushion.model"), picture = at("cushion/depth/000000.png"),
                    camera = at("cushion/camera.toml"), out = at("result.ply");
  expect_refused(run_pliant({"register", "--model", at("none"), "--scene", picture, "-o", out}), 2, {"none"});
  expect_refused(run_pliant({"register", "--model", model, "--scene", at("none.ply"), "-o", out}), 2,
                 {"none.ply"});
  expect_refused(
      run_pliant({"register", "--model", model, "--scene", at("none.png"), "--camera", camera, "-o", out}), 2,
      {"none.png"});
  expect_refused(run_pliant({"register", "--model", model, "--scene", picture, "-o", out}), 2, {"--camera"});
  expect_refused(run_pliant({"register", "--model", model, "--scene", at("cushion/model.ply"), "--camera",
                             camera, "-o", out}),
                 2, {"--camera"});
  expect_refused(
      run_pliant({"register", "--model", model, "--scene", picture, "--camera", at("none.toml"), "-o", out}),
      2, {"none.toml"});
  write_file(at("cut.png"), read_file(picture).substr(0, 3000));
  expect_refused(
      run_pliant({"register", "--model", model, "--scene", at("cut.png"), "--camera", camera, "-o", out}), 2,
      {"cut.png"});
  std::string other = read_file(camera);
  other.replace(other.find("320"), 3, "640");
  write_file(at("other.toml"), other);
  expect_refused(
      run_pliant({"register", "--model", model, "--scene", picture, "--camera", at("other.toml"), "-o", out}),
      2, {"320x240", "640x240"});
  expect_refused(run_pliant({"register", "--model", model, "--scene", picture, "--camera", camera, "-o",
                             at("no/folder/r.ply")}),
                 3, {"folder/r.ply"});
  for (const auto& [option, value] : {std::pair{"--max-regions", "9"},
                                      {"--max-instances", "0"},
                                      {"--keypoints", "10,20"},
                                      {"--viewpoint", "1,2"},
                                      {"--threads", "17"}})
    expect_refused(run_pliant({"register", "--model", model, "--scene", picture, "-o", out, option, value}),
                   2, {option});
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace pliant::test

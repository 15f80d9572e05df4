// pliant model capture, from files of single views.
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <sstream>

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/images/png.hpp"
#include "tests/commands/capture_command.hpp"

namespace pliant::test {
namespace {

/// Pictures of the figure from all round, far apart.
class ViewsCommand : public CaptureCommand {
 protected:
  static constexpr int kViews = 14;
  ViewsCommand() {
    const Ended recorded =
        run_pliant({"record", "--source",
                    "simulated:figure?motion=turned&width=320&height=240&frames=" + std::to_string(kViews),
                    "-o", at("views")});
    EXPECT_EQ(recorded.code, 0) << recorded.err;
  }
  [[nodiscard]] std::string picture(int i) const {
    return at((i < 10 ? "views/depth/00000" : "views/depth/0000") + std::to_string(i) + ".png");
  }
  [[nodiscard]] std::string camera() const { return at("views/camera.toml"); }
  /// The readings of picture i as a cloud in the camera's frame.
  [[nodiscard]] std::string cloud(int i) const {
    GreyImage16 image;
    EXPECT_TRUE(PngReader().read(picture(i), image));
    Geometry geometry;
    for (int v = 0; v < image.height; ++v)
      for (int u = 0; u < image.width; ++u) {
        const auto z = static_cast<float>(image.pixels[static_cast<std::size_t>(v * image.width + u)]) / 1000;
        if (z > 0)
          geometry.vertices.push_back(
              {static_cast<float>(u - 160) / 285 * z, static_cast<float>(v - 120) / 285 * z, z});
      }
    const std::string path = at("cloud" + std::to_string(i) + ".ply");
    EXPECT_TRUE(write_ply(path, geometry));
    return path;
  }
  [[nodiscard]] std::vector<std::string> capture_of(const std::vector<std::string>& views) const {
    std::vector<std::string> command = {"model", "capture"};
    command.insert(command.end(), views.begin(), views.end());
    command.insert(command.end(), {"-o", at("figure.model"), "--ply", at("figure.ply"), "--size", "0.45"});
    return command;
  }
  [[nodiscard]] std::vector<std::string> pictures() const {
    std::vector<std::string> views;
    for (int i = 0; i < kViews; ++i) views.push_back(picture(i));
    return views;
  }
  [[nodiscard]] std::vector<std::string> clouds() const {
    std::vector<std::string> views;
    for (int i = 0; i < kViews; ++i) views.push_back(cloud(i));
    return views;
  }
  /// A view at a wrong place makes the figure thicker: its true size is known. Metres.
  void expect_true_size() const {
    const Result<Geometry> captured = read_geometry(at("figure.ply"));
    ASSERT_TRUE(captured) << captured.error().message;
    ASSERT_EQ(run_pliant({"model", "build", "simulated:figure", "-o", at("true.model")}).code, 0);
    ASSERT_EQ(run_pliant({"model", "export", at("true.model"), "-o", at("true.ply")}).code, 0);
    const Result<Geometry> truth = read_geometry(at("true.ply"));
    ASSERT_TRUE(truth) << truth.error().message;
    EXPECT_NEAR(widest(*captured), widest(*truth), 0.006);
    EXPECT_NEAR(spread(*captured), spread(*truth), 0.003);
  }

 private:
  /// Farthest from the middle, aside of the upright axis.
  static double widest(const Geometry& geometry) {
    double most = 0;
    const auto& points = geometry.vertices;
    for (std::size_t i = 0; i < points.size(); i += 7)
      for (std::size_t j = 0; j < i; j += 7)
        most = std::max(most, std::hypot(static_cast<double>(points[i].x - points[j].x),
                                         static_cast<double>(points[i].y - points[j].y)));
    return most;
  }
  /// Root mean square distance from the upright axis through the mean.
  static double spread(const Geometry& geometry) {
    double x = 0, y = 0, square = 0;
    const auto n = static_cast<double>(geometry.vertices.size());
    for (const Point3f& p : geometry.vertices) {
      x += static_cast<double>(p.x) / n;
      y += static_cast<double>(p.y) / n;
    }
    for (const Point3f& p : geometry.vertices)
      square += (std::pow(static_cast<double>(p.x) - x, 2) + std::pow(static_cast<double>(p.y) - y, 2)) / n;
    return std::sqrt(square);
  }
};

TEST_F(ViewsCommand, DepthPicturesFindTheirPlaces) {
  std::vector<std::string> command = capture_of(pictures());
  command.insert(command.end(), {"--camera", camera()});
  const Ended captured = run_pliant(command);
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_EQ(captured.err.find("left out"), std::string::npos) << captured.err;
  EXPECT_NE(captured.out.find("fused: 14 of 14 pictures"), std::string::npos) << captured.out;
  EXPECT_NE(captured.out.find("seen: 8 of 8 sides\n"), std::string::npos) << captured.out;
  expect_true_size();
}

TEST_F(ViewsCommand, CloudsFindTheirPlaces) {
  const Ended captured = run_pliant(capture_of(clouds()));
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_NE(captured.out.find("fused: 14 of 14 pictures"), std::string::npos) << captured.out << captured.err;
  expect_true_size();
}

TEST_F(ViewsCommand, KnownPosesArePutToThePositionsOfTheFiles) {
  // The recording's stamps become positions.
  std::istringstream truth(read_file(at("views/groundtruth.txt")));
  std::string line, poses;
  for (int i = 0; std::getline(truth, line);)
    if (line[0] != '#') poses += std::to_string(i++) + line.substr(line.find(' ')) + "\n";
  write_file(at("poses.txt"), poses);
  std::vector<std::string> command = capture_of(clouds());
  command.insert(command.end(), {"--poses", at("poses.txt")});
  const Ended captured = run_pliant(command);
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_NE(captured.out.find("fused: 14 of 14 pictures"), std::string::npos) << captured.out;
  expect_true_size();
}

TEST_F(ViewsCommand, OneViewMakesAFrontOnlyModel) {
  const Ended captured = run_pliant(capture_of({cloud(0)}));
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_NE(captured.out.find("back: unknown"), std::string::npos) << captured.out;
  EXPECT_EQ(run_pliant({"model", "build", at("figure.ply"), "-o", at("again.model")}).code, 0);
}

TEST_F(ViewsCommand, AViewOfSomethingElseIsLeftOutByName) {
  ASSERT_EQ(
      run_pliant({"record", "--source", "simulated:box?width=320&height=240&frames=1", "-o", at("box")}).code,
      0);
  const std::string other = at("box/depth/000000.png");
  std::vector<std::string> command = capture_of({picture(0), other, picture(1)});
  command.insert(command.end(), {"--camera", camera()});
  const Ended captured = run_pliant(command);
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_NE(captured.err.find(other + ": left out"), std::string::npos) << captured.err;
  EXPECT_NE(captured.out.find("fused: 2 of 2 pictures"), std::string::npos) << captured.out;
}

TEST_F(ViewsCommand, AnInterruptKeepsTheViewsThatArePlaced) {
  std::vector<std::string> command = capture_of(pictures());
  command.insert(command.end(), {"--camera", camera()});
  const pid_t process = start_pliant(command, folder_);
  // Its first line comes when the views are about to be placed, which takes seconds.
  for (int i = 0; i < 500 && read_file(folder_ / "out.txt").empty(); ++i) usleep(20'000);
  usleep(700'000);
  kill(process, SIGTERM);
  const Ended ended = wait_for(process, folder_);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("left out, the capture was ended before"), std::string::npos) << ended.err;
  EXPECT_EQ(run_pliant({"model", "info", at("figure.model")}).code, 0);
}

TEST_F(ViewsCommand, WhatCannotBeAViewIsRefused) {
  expect_refused(run_pliant(capture_of({picture(0)})), 2, {"000000.png", "--camera"});
  expect_refused(run_pliant(capture_of({at("none.ply")})), 2, {"none.ply"});
  write_file(at("around.xyz.ply"),
             "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
             "end_header\n0 0 -0.1\n0 0 -0.2\n");
  expect_refused(run_pliant(capture_of({at("around.xyz.ply")})), 2,
                 {"around.xyz.ply", "lie before the camera", "model build"});
  std::vector<std::string> command = capture_of({picture(0)});
  command.insert(command.end(), {"--source", kTurned});
  expect_refused(run_pliant(command), 2, {"--source", "exclude"});
  expect_refused(run_pliant(capture_of(std::vector<std::string>(60, picture(0)))), 2,
                 {"60 views", "recording"});
  command = words(kTurned, at("m"));
  command.insert(command.end(), {"--camera", camera()});
  expect_refused(run_pliant(command), 2, {"--camera", "files"});
  expect_refused(run_pliant({"model", "capture", "-o", at("m")}), 2, {"--source", "files"});
  command = capture_of({cloud(0)});
  command.insert(command.end(), {"--frames", "1"});
  expect_refused(run_pliant(command), 2, {"--frames", "source"});
}

}  // namespace
}  // namespace pliant::test

// pliant model capture.
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <sstream>

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/images/png.hpp"
#include "drivers/lcm/frame_assembler.hpp"
#include "drivers/lcm/subscriber.hpp"
#include "tests/commands/program.hpp"

namespace pliant::test {
namespace {

/// Small pictures and coarse voxels: what is written counts here, how good it is in tests/capture.
class CaptureCommand : public CommandTest {
 protected:
  [[nodiscard]] static std::vector<std::string> words(const std::string& source, const std::string& output) {
    return {"model",  "capture", "--source", source,  "-o",        output,
            "--size", "0.4",     "--voxel",  "0.004", "--lcm-url", "none"};
  }
};

constexpr const char* kTurned = "simulated:box?motion=turned&frames=70&width=320&height=240";

TEST_F(CaptureCommand, MakesAModelThatCanBeTracked) {
  std::vector<std::string> command = words(kTurned, at("box.model"));
  command.insert(command.end(), {"--ply", at("box.ply")});
  const Ended captured = run_pliant(command);
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_TRUE(captured.out.starts_with("memory: ")) << captured.out;
  EXPECT_NE(captured.out.find("fused: 70 of 70 pictures"), std::string::npos) << captured.out;
  EXPECT_NE(captured.out.find("seen: 8 of 8 sides\n"), std::string::npos) << captured.out;
  EXPECT_NE(captured.out.find("characterisable: yes"), std::string::npos) << captured.out;
  EXPECT_EQ(captured.out.find("back: unknown"), std::string::npos) << captured.out;
  EXPECT_NE(captured.err.find("seen from all sides"), std::string::npos) << captured.err;

  const Result<Geometry> surface = read_geometry(at("box.ply"));
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_GT(surface->triangles.size(), 3000U);
  EXPECT_EQ(run_pliant({"model", "build", at("box.ply"), "-o", at("again.model")}).code, 0);

  const Ended tracked = run_pliant({"run", "--model", at("box.model"), "--source",
                                    "simulated:box?frames=40&width=320&height=240", "--lcm-url", "none"});
  EXPECT_EQ(tracked.code, 0) << tracked.out << tracked.err;
}

TEST_F(CaptureCommand, MarksAModelOfOneSideAsFrontOnly) {
  const Ended captured =
      run_pliant(words("simulated:figure?frames=12&width=320&height=240", at("front.model")));
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_NE(captured.out.find("back: unknown"), std::string::npos) << captured.out;
  EXPECT_NE(captured.out.find("not the front right"), std::string::npos) << captured.out;
  const Ended info = run_pliant({"model", "info", at("front.model")});
  EXPECT_NE(info.out.find("back: unknown"), std::string::npos) << info.out;
}

TEST_F(CaptureCommand, CapturingTwiceGivesTheSameBytes) {
  const char* const source = "simulated:box?motion=circled&frames=12&width=320&height=240";
  ASSERT_EQ(run_pliant(words(source, at("a.model"))).code, 0);
  ASSERT_EQ(run_pliant(words(source, at("b.model"))).code, 0);
  EXPECT_EQ(read_file(at("a.model")), read_file(at("b.model")));
}

TEST_F(CaptureCommand, SaysWhenNothingStandsThere) {
  const std::string folder = small_recording(3);
  std::vector<std::string> command = words("recording:" + folder, at("m"));
  // A volume far smaller than anything in the picture: nothing counts as an object.
  command[7] = std::string("0.05");
  const Ended ended = run_pliant(command);
  EXPECT_EQ(ended.code, 1) << ended.out;
  EXPECT_NE(ended.err.find("nothing was captured"), std::string::npos) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(at("m")));
}

TEST_F(CaptureCommand, PublishesTheModelAsItGrows) {
  std::vector<std::string> command = words(kTurned, at("box.model"));
  command.back() = "file://" + at("run.log") + "?mode=w";
  ASSERT_EQ(run_pliant(command).code, 0);
  std::vector<std::size_t> sizes;
  std::int64_t tracking = 0, pictures = 0;
  std::string told;
  ModelAssembler models;
  LcmSubscriber::Handlers handlers;
  handlers.model = [&](const ModelMessage& message) {
    if (models.take(message)) sizes.push_back(models.model().points.size());
  };
  handlers.regions = [&](const RegionsMessage& message) {
    tracking += message.state == TrackState::tracking ? 1 : 0;
  };
  handlers.depth = [&](const DepthMessage& message) { pictures += message.part == 0 ? 1 : 0; };
  handlers.status = [&](const StatusMessage& message) { told = message.last_error; };
  const auto log = LcmSubscriber::create("file://" + at("run.log") + "?speed=0", "PLIANT_CAPTURE", handlers);
  ASSERT_TRUE(log);
  while ((*log)->handle(100) > 0) {
  }
  ASSERT_GE(sizes.size(), 2U);
  EXPECT_GT(sizes.back(), 2 * sizes.front());
  EXPECT_GT(tracking, 30);
  EXPECT_GT(pictures, 2);
  EXPECT_NE(told.find("of 8 sides"), std::string::npos) << told;
  // On the tracker's own channels nobody hears of it.
  const auto tracker = LcmSubscriber::create("file://" + at("run.log") + "?speed=0", "PLIANT", {});
  ASSERT_TRUE(tracker);
  while ((*tracker)->handle(100) > 0) {
  }
  EXPECT_EQ((*tracker)->counters().total(), 0);
}

TEST_F(CaptureCommand, ADiskThatIsFullLosesNothing) {
  const Ended ended = run_pliant(words("simulated:box?frames=8&width=320&height=240", "/dev/full"));
  EXPECT_EQ(ended.code, 3);
  const std::size_t kept = ended.err.find("kept as ");
  ASSERT_NE(kept, std::string::npos) << ended.err;
  const std::string path = ended.err.substr(kept + 8, ended.err.find('\n', kept) - kept - 8);
  EXPECT_EQ(run_pliant({"model", "info", path}).code, 0) << path;
  std::filesystem::remove(path);
}

TEST_F(CaptureCommand, AnInterruptKeepsWhatIsThere) {
  const pid_t process = start_pliant(
      words("simulated:box?motion=turned&frames=100000&width=320&height=240", at("box.model")), folder_);
  for (int i = 0; i < 200 && read_file(folder_ / "out.txt").empty(); ++i) usleep(20'000);
  usleep(1'500'000);
  kill(process, SIGINT);
  const Ended ended = wait_for(process, folder_);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(run_pliant({"model", "info", at("box.model")}).code, 0);
}

TEST_F(CaptureCommand, TakesKnownPoses) {
  const std::string folder = at("recording");
  ASSERT_EQ(run_pliant({"record", "--source", "simulated:box?motion=circled&frames=20&width=320&height=240",
                        "-o", folder})
                .code,
            0);
  std::vector<std::string> command = words("recording:" + folder, at("known.model"));
  command.insert(command.end(), {"--poses", folder + "/groundtruth.txt"});
  const Ended captured = run_pliant(command);
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_NE(captured.out.find("fused: 20 of 20 pictures"), std::string::npos) << captured.out;
  command.back() = at("other.txt");
  write_file(command.back(), "999.5 0 0 1 0 0 0 1\n");
  expect_refused(run_pliant(command), 2, {"other.txt", "no pose has the time"});
  write_file(command.back(), "1 2 3\n");
  expect_refused(run_pliant(command), 2, {"other.txt:1"});
}

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
}

TEST_F(CaptureCommand, BadWordsAreRefused) {
  std::vector<std::string> command = words(kTurned, at("m"));
  command.insert(command.end(), {"--at", "700", "10"});
  expect_refused(run_pliant(command), 2, {"--at 700 10", "320x240"});
  expect_refused(run_pliant(words("recording:none", at("m"))), 2, {"none"});
  expect_refused(run_pliant({"model", "capture", "--source", kTurned}), 2, {"--output"});
  command = words(kTurned, at("m"));
  command[7] = std::string("7");
  expect_refused(run_pliant(command), 2, {"--size"});
}

}  // namespace
}  // namespace pliant::test

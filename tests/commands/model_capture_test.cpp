// pliant model capture, from a source.
#include <signal.h>
#include <unistd.h>

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/lcm/frame_assembler.hpp"
#include "drivers/lcm/subscriber.hpp"
#include "drivers/recording/recording_writer.hpp"
#include "drivers/simulated/still_mesh.hpp"
#include "tests/capture/other_objects.hpp"
#include "tests/commands/capture_command.hpp"

namespace pliant::test {
namespace {

/// A recording of an object that stands before the simulated sensor.
void record(const Geometry& object, const std::string& options, const std::string& folder) {
  const auto source = open_still_mesh(object, options);
  ASSERT_TRUE(source) << source.error().message;
  const auto recording = RecordingWriter::create(folder, {(*source)->intrinsics(), (*source)->sensor()});
  ASSERT_TRUE(recording) << recording.error().message;
  SourceItem item;
  for ((*source)->next(0, item); item.event == SourceEvent::frame; (*source)->next(0, item))
    ASSERT_TRUE((*recording)->write(item.frame));
  ASSERT_TRUE((*recording)->finish());
}

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

TEST_F(CaptureCommand, SaysThatItCannotSeeABottleTurn) {
  const std::string folder = at("turned");
  record(plain_bottle(), "?motion=turned&frames=90&width=320&height=240", folder);
  const Ended captured = run_pliant(words("recording:" + folder, at("bottle.model")));
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_NE(captured.err.find("whether it turns cannot be seen; carry the sensor"), std::string::npos)
      << captured.err;
  EXPECT_NE(captured.err.find("its turning could not be seen: in 89 of 90 pictures"), std::string::npos)
      << captured.err;
  EXPECT_NE(captured.err.find("The model is of one side"), std::string::npos) << captured.err;
  EXPECT_NE(captured.out.find("seen: 1 of 8 sides"), std::string::npos) << captured.out;
  const Ended info = run_pliant({"model", "info", at("bottle.model")});
  EXPECT_NE(info.out.find("back: unknown"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("characterisable: no"), std::string::npos) << info.out;
}

TEST_F(CaptureCommand, DoesNotDoubtABottleWhoseLugsShowItsTurning) {
  const std::string folder = at("turned");
  record(bottle_with_lugs(), "?motion=turned&frames=100&width=320&height=240", folder);
  std::vector<std::string> command = words("recording:" + folder, at("bottle.model"));
  command[9] = std::string("0.002");  // lugs are two centimetres wide
  const Ended captured = run_pliant(command);
  EXPECT_EQ(captured.code, 0) << captured.err;
  EXPECT_EQ(captured.err.find("featureless"), std::string::npos) << captured.err;
  EXPECT_EQ(captured.err.find("could not be seen"), std::string::npos) << captured.err;
  EXPECT_NE(captured.out.find("seen: 8 of 8 sides\n"), std::string::npos) << captured.out;
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

TEST_F(CaptureCommand, AFolderThatIsMissingIsToldBeforeAnythingIsTurned) {
  expect_refused(run_pliant(words(kTurned, at("none/box.model"))), 3, {"none/box.model", "make it first"});
  std::vector<std::string> command = words(kTurned, at("box.model"));
  command.insert(command.end(), {"--ply", at("none/box.ply")});
  expect_refused(run_pliant(command), 3, {"none/box.ply", "make it first"});
}

TEST_F(CaptureCommand, AnOutputThatIsNoFileIsToldBeforeAnythingIsTurned) {
  expect_refused(run_pliant(words(kTurned, "")), 2, {"--output: names no file"});
  const Ended folder = run_pliant(words(kTurned, folder_));
  expect_refused(folder, 3, {"name a file, not a folder"});
  EXPECT_EQ(folder.out, "");
  // Nothing is left behind by looking, and a model that is there stays until the new one is whole.
  write_file(at("box.model"), "old");
  std::vector<std::string> command = words("recording:none", at("box.model"));
  EXPECT_EQ(run_pliant(command).code, 2);
  EXPECT_EQ(read_file(at("box.model")), "old");
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
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

TEST_F(CaptureCommand, ASurfaceThatCannotBeWrittenIsAFailureAndTheModelIsKept) {
  std::vector<std::string> command = words("simulated:box?frames=8&width=320&height=240", at("box.model"));
  command.insert(command.end(), {"--ply", "/dev/full"});
  const Ended ended = run_pliant(command);
  EXPECT_EQ(ended.code, 3);
  EXPECT_NE(ended.err.find("/dev/full: cannot be written"), std::string::npos) << ended.err;
  EXPECT_EQ(run_pliant({"model", "info", at("box.model")}).code, 0);
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

TEST_F(CaptureCommand, TheSensorsDescriptionWinsOverTheSource) {
  write_file(at("sensor.toml"), "[noise]\nnoise_floor = 0.01\n");
  const std::vector<std::string> plain = {
      "model", "capture", "--source", "simulated:box?frames=2&width=160&height=120", "-o", at("m")};
  std::vector<std::string> described = plain;
  described.insert(described.end(), {"--sensor", at("sensor.toml")});
  const auto voxels = [](const Ended& ended) { return ended.out.substr(0, ended.out.find('\n')); };
  const std::string without = voxels(run_pliant(plain)), with = voxels(run_pliant(described));
  EXPECT_TRUE(with.starts_with("memory: ")) << with;
  EXPECT_NE(with, without);  // their size follows from the noise
}

TEST_F(CaptureCommand, AMalformedNetworkIsRefused) {
  for (const char* url : {"bogus", "udpm://1.2.3.4:1", "file://x"}) {
    std::vector<std::string> command = words(kTurned, at("m"));
    command.back() = url;
    expect_refused(run_pliant(command), 2, {url});
    EXPECT_FALSE(std::filesystem::exists(at("m")));
  }
}

TEST_F(CaptureCommand, BadWordsAreRefused) {
  std::vector<std::string> command = words(kTurned, at("m"));
  command.insert(command.end(), {"--at", "700", "10"});
  expect_refused(run_pliant(command), 2, {"--at 700 10", "320x240"});
  expect_refused(run_pliant(words("recording:none", at("m"))), 2, {"none"});
  expect_refused(run_pliant(words("recording:", at("m"))), 2,
                 {"recording: names no folder", "recording:DIR"});
  expect_refused(run_pliant(words("recording:" + folder_.string(), at("m"))), 2,
                 {"holds no camera.toml", "a recording is"});
  write_file(at("mesh.ply"), "ply\n");
  expect_refused(run_pliant(words(at("mesh.ply"), at("m"))), 2, {"mesh.ply", "'pliant model build'"});
  expect_refused(run_pliant({"model", "capture", "--source", kTurned}), 2, {"--output"});
  command = words(kTurned, at("m"));
  command[7] = std::string("7");
  expect_refused(run_pliant(command), 2, {"--size"});
}

}  // namespace
}  // namespace pliant::test

// Whole captures: what is fused, what is left out, and what it costs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "drivers/simulated/still_mesh.hpp"
#include "firmware-app/commands/capture_guide.hpp"
#include "firmware-app/measure/path_cost.hpp"
#include "tests/capture/capture_run.hpp"
#include "tests/capture/other_objects.hpp"
#include "tests/capture/scene.hpp"

namespace pliant::test {
namespace {

/// A capture of drawn scenes.
class DrawnCapture : public testing::Test {
 protected:
  DrawnCapture() {
    settings_.size = 0.3;
    const std::size_t bytes = ObjectCapture::workspace_bytes(small_camera(), {}, settings_);
    block_ = block_of(bytes);
    EXPECT_EQ(capture_.start(small_camera(), {}, settings_, {block_.get(), bytes}), nullptr);
  }
  const CaptureStatus& show(const std::function<double(const Vector3&)>& nearest) {
    return capture_.process(Picture(nearest, number_++).frame());
  }
  CaptureSettings settings_;
  Block block_;
  ObjectCapture capture_;
  std::int64_t number_ = 0;
};

constexpr double kBall = 0.06;
const Vector3 kMiddle(0, 0.005, 0.66);

double ball_on_table(const Vector3& ray) {
  return nearer(table_depth(ray), ball_depth(ray, kMiddle, kBall));
}

TEST_F(DrawnCapture, WaitsWhileNothingStandsOnTheTable) {
  for (int i = 0; i < 5; ++i) EXPECT_EQ(show(table_depth).state, CaptureState::waiting);
  EXPECT_EQ(show(ball_on_table).state, CaptureState::capturing);
}

TEST_F(DrawnCapture, SaysThatTheSensorIsTooNearWhenThereIsNoReading) {
  const CaptureStatus& status = show([](const Vector3&) { return 0; });
  EXPECT_EQ(status.state, CaptureState::waiting);
  EXPECT_TRUE(status.too_near);
}

TEST_F(DrawnCapture, ABallIsCalledFeatureless) {
  for (int i = 0; i < 6; ++i) EXPECT_EQ(show(ball_on_table).state, CaptureState::capturing);
  EXPECT_TRUE(show(ball_on_table).featureless);
}

/// What is captured of `object`, and in which share of the pictures it was called featureless.
double featureless_share(const Geometry& object, const std::string& options, CaptureRun& run) {
  const auto source = open_still_mesh(object, options);
  EXPECT_TRUE(source) << options;
  if (!source) return -1;
  run.run(**source);
  const CaptureFigures& figures = run.capture.figures();
  EXPECT_EQ(figures.fused, figures.frames);
  return static_cast<double>(figures.featureless) / static_cast<double>(figures.fused);
}

TEST(ObjectCapture, WhatIsRoundIsCalledFeatureless) {
  const auto expect_featureless = [](const Geometry& object, const char* motion) {
    CaptureRun run;
    EXPECT_GT(featureless_share(object, std::string(motion) + "&frames=60&width=320&height=240", run), 0.95)
        << motion;
    EXPECT_NE(doubt_of_turning(run.capture.figures(), run.capture.coverage()), "");
  };
  for (const char* const motion : {"?motion=turned", "?motion=carried"}) {
    expect_featureless(plain_bottle(), motion);
    expect_featureless(ball(), motion);
  }
}

/// A hundredth of its surface tells how a bottle is turned.
void expect_held_by_its_lugs(const char* options, double most_featureless) {
  CaptureRun run;
  EXPECT_LT(featureless_share(bottle_with_lugs(), options, run), most_featureless);
  EXPECT_EQ(doubt_of_turning(run.capture.figures(), run.capture.coverage()), "");
  EXPECT_EQ(run.capture.coverage().sectors_seen(), Coverage::kSectors);
  run.finish();
  run.compare();
  EXPECT_LT(run.score.median, 0.0015);
  EXPECT_LT(run.score.p95, 0.004);
  EXPECT_GT(run.score.coverage, 0.95);
  EXPECT_LT(run.score.seam, 0.003);
}

TEST(ObjectCapture, AHandleThatGoesOutOfSightLeavesItsTurnInDoubt) {
  CaptureRun run;
  const Geometry object = bottle(std::array{Lug{-1.4, 0.09, 0.02}, Lug{-0.4, 0.11, 0.02}});
  EXPECT_LT(featureless_share(object, "?motion=turned&frames=200&width=320&height=240", run), 0.5);
  EXPECT_GE(run.capture.figures().longest_unheld, kUnheldStretch);
  EXPECT_NE(doubt_of_turning(run.capture.figures(), run.capture.coverage()), "");
}

TEST(ObjectCapture, LugsTooLowToHoldABottleAreNotPraised) {
  // Half as high, they lean by 18° at most and on two hundredths of the surface: poses come to lie turned by
  // 5 to 45°, which the surface, round as it is, does not show.
  CaptureRun run;
  const Geometry object =
      bottle(std::array{Lug{-1.4, 0.09, 0.005}, Lug{0.5, 0.11, 0.005}, Lug{2.8, 0.07, 0.005}});
  EXPECT_GT(featureless_share(object, "?motion=carried&frames=60&width=320&height=240", run), 0.9);
  EXPECT_NE(doubt_of_turning(run.capture.figures(), run.capture.coverage()), "");
}

TEST(ObjectCapture, FewLugsAreEnoughForACarriedSensor) {
  expect_held_by_its_lugs("?motion=carried&frames=100&width=320&height=240", 0.3);
}

TEST(ObjectCapture, FewLugsAreEnoughOnATurntable) {
  // Until it has turned by some degrees, errors of the same pixels may be what holds it.
  expect_held_by_its_lugs("?motion=turned&frames=100&width=320&height=240", 0.4);
}

TEST_F(DrawnCapture, ABallFarAwayIsCalledTooFar) {
  const auto far = [](const Vector3& ray) {
    const Vector3 up(0, -0.8191520, -0.5735764);
    const double z = plane_depth(ray, up, up.dot(Vector3(0, 0.1, 1.7)));
    return nearer(z < 3 ? z : 0, ball_depth(ray, {0, 0, 1.62}, 0.12));
  };
  EXPECT_TRUE(show(far).too_far);
  EXPECT_FALSE(show(ball_on_table).too_far);
}

TEST_F(DrawnCapture, AHandThatComesIntoThePictureIsNotFused) {
  for (int i = 0; i < 10; ++i) static_cast<void>(show(ball_on_table));
  for (int i = 0; i < 20; ++i) {
    // A thick finger comes down upon the ball from the side.
    const Vector3 finger(0.10 - 0.003 * i, -0.07, 0.62);
    const auto& status =
        show([&](const Vector3& ray) { return nearer(ball_on_table(ray), ball_depth(ray, finger, 0.025)); });
    EXPECT_EQ(status.state, CaptureState::capturing) << i;
    EXPECT_TRUE(status.against) << i;
  }
  const Geometry mesh = captured_mesh(capture_.volume(), {});
  ASSERT_FALSE(mesh.vertices.empty());
  // The ball's middle in the model's frame, from any captured pose.
  const RigidTransform pose = show(ball_on_table).pose;
  double farthest = 0;
  for (const Point3f& p : mesh.vertices)
    farthest = std::max(farthest, std::fabs((pose * to_vector(p) - kMiddle).norm() - kBall));
  EXPECT_LT(farthest, 0.006);
}

TEST_F(DrawnCapture, RefusesWhatIsOutOfRange) {
  CaptureSettings settings;
  settings.size = 3;
  EXPECT_NE(capture_.start(small_camera(), {}, settings, {}), nullptr);
  settings.size = 0.3;
  settings.voxel = 1;
  EXPECT_NE(capture_.start(small_camera(), {}, settings, {}), nullptr);
  settings.voxel = 0;
  EXPECT_NE(capture_.start(small_camera(), {}, settings, {block_.get(), 4096}), nullptr)
      << "too small a block";
  SensorDescription sensor;
  sensor.noise_growth = std::nan("");
  EXPECT_STREQ(capture_.start(small_camera(), sensor, {}, {}), "noise_growth must be 0 to 0.1 1/m");
}

TEST(ObjectCapture, MakesNoHeapCallInAPicture) {
  if (!heap_is_watched()) GTEST_SKIP() << "a sanitizer brings a heap of its own";
  const auto source = simulated("box?motion=turned&frames=40&width=320&height=240");
  const std::size_t bytes = ObjectCapture::workspace_bytes(source->intrinsics(), source->sensor(), {});
  const Block block = block_of(bytes);
  ObjectCapture capture;
  ASSERT_EQ(capture.start(source->intrinsics(), source->sensor(), {}, {block.get(), bytes}), nullptr);
  PathCost cost;
  SourceItem item;
  for (source->next(0, item); item.event == SourceEvent::frame; source->next(0, item)) {
    const PathWatch watch(cost);
    static_cast<void>(capture.process(item.frame));
  }
  {
    const PathWatch watch(cost);
    static_cast<void>(capture.finish());
  }
  EXPECT_EQ(cost.heap_calls.load(), 0U);
  EXPECT_GT(capture.keyframes().all().size(), 10U);
}

TEST(BackgroundPlanes, WhatStandsLevelWithTheObjectIsNoTable) {
  // A low block, and a rail as high to either side: together they reach twice as far as a table must.
  const auto scene = [](const Vector3& ray) {
    const Vector3 up(0, -0.8191520, -0.5735764), along(0, 0.5735764, -0.8191520), foot(0, 0.08, 0.7);
    const double z = plane_depth(ray, up, up.dot(foot) + 0.05);
    const Vector3 p = z * ray;
    const double forward = along.dot(p - foot);
    const bool block = std::fabs(p.x()) < 0.07 && std::fabs(forward) < 0.05;
    const bool rail = std::fabs(p.x()) < 0.5 && std::fabs(forward) < 0.02;
    return block || rail ? nearer(table_depth(ray), z) : table_depth(ray);
  };
  Surface surface;
  BackgroundPlanes planes;
  const auto lay_out = [&](Workspace& workspace) {
    surface.lay_out(workspace, small_camera());
    planes.lay_out(workspace, small_camera());
  };
  Workspace measured;
  lay_out(measured);
  const Block block = block_of(measured.used());
  Workspace workspace({block.get(), measured.used()});
  lay_out(workspace);
  surface.start(small_camera(), {}, Kernels::automatic);
  planes.start(surface, 0.3);
  surface.build(Picture(scene).frame(), {0, 0, small_camera().width, small_camera().height});
  planes.update(surface);
  EXPECT_EQ(planes.planes().size(), 1U);
}

/// FNV-1a over the volume.
std::uint64_t digest(const DistanceVolume& volume) {
  std::uint64_t hash = 14695981039346656037U;
  const int n = volume.plan().cells;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Voxel& voxel = volume.at(x, y, z);
        const auto word =
            static_cast<std::uint32_t>(static_cast<std::uint16_t>(voxel.distance)) << 16 | voxel.weight;
        hash = (hash ^ word) * 1099511628211U;
      }
  return hash;
}

std::uint64_t digest_with(Kernels kernels) {
  const auto source = simulated("cushion?motion=turned&frames=24&width=320&height=240");
  CaptureSettings settings;
  settings.kernels = kernels;
  settings.size = 0.4;
  settings.voxel = 0.004;
  CaptureRun run;
  run.run(*source, settings);
  run.finish();
  return digest(run.capture.volume());
}

TEST(ObjectCapture, AllKernelsGiveTheSameVolume) {
  EXPECT_EQ(digest_with(Kernels::scalar), digest_with(Kernels::automatic));
}

TEST(ObjectCapture, IsLostWhenTheObjectJumpsAndFindsItAgain) {
  const auto source = simulated("figure?motion=turned&frames=150&width=320&height=240");
  const std::size_t bytes = ObjectCapture::workspace_bytes(source->intrinsics(), source->sensor(), {});
  const Block block = block_of(bytes);
  ObjectCapture capture;
  ASSERT_EQ(capture.start(source->intrinsics(), source->sensor(), {}, {block.get(), bytes}), nullptr);
  std::vector<std::vector<std::uint16_t>> pictures;
  SourceItem item;
  for (source->next(0, item); item.event == SourceEvent::frame; source->next(0, item))
    pictures.emplace_back(item.frame.depth, item.frame.depth + 320 * 240);
  std::int64_t number = 0;
  const auto show = [&](std::size_t i) -> const CaptureStatus& {
    return capture.process({pictures[i].data(), 320, 240, 320, 33333 * number, number++});
  };
  for (std::size_t i = 0; i < 40; ++i) ASSERT_EQ(show(i).state, CaptureState::capturing) << i;
  const std::int64_t fused = capture.figures().fused;
  // A quarter of a turn on in one picture: nothing of it may be fused.
  for (std::size_t i = 85; i < 90; ++i) EXPECT_EQ(show(i).state, CaptureState::lost) << i;
  EXPECT_EQ(capture.figures().fused, fused);
  EXPECT_EQ(show(39).state, CaptureState::capturing) << "shown again what was seen last";
}

}  // namespace
}  // namespace pliant::test

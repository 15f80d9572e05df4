// The tracker as its users meet it.
#include "core/tracker.hpp"
#include "core/memory/row_major.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/core/synthetic.hpp"

namespace pliant {
namespace {

using synthetic::degrees_between;
using synthetic::OwnedWorkspace;
using synthetic::Picture;
using synthetic::pose_at;

class TrackerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    mesh_ = std::make_unique<Geometry>(synthetic::bumpy_body());
    file_ = std::make_unique<ModelFile>(synthetic::model_of(*mesh_));
  }
  static void TearDownTestSuite() {
    mesh_.reset();
    file_.reset();
  }
  static const ModelView& model() { return file_->view(); }
  static RigidTransform pose(int frame) {
    return pose_at({0.002 * frame, 0.001 * frame, 0.7}, {1, 2, 0.5}, 0.6 + 0.01 * frame);
  }

  void start(const TrackSettings& settings = {}) {
    block_ = OwnedWorkspace::aligned(storage_, Tracker::workspace_bytes(model(), camera_, settings));
    ASSERT_EQ(tracker_.start(model(), camera_, SensorDescription(), settings, block_), nullptr);
  }
  const TrackResult& see(int frame, bool there = true) {
    Picture picture(camera_);
    if (there) picture.draw(*mesh_, pose(frame));
    picture.wall(1.5);
    picture.shake(0.001, static_cast<unsigned>(frame));
    current_ = picture;
    return tracker_.process(current_->frame(frame));
  }
  static void expect_nothing(const TrackResult& r) {
    EXPECT_NE(r.state, TrackState::tracking);
    EXPECT_TRUE(r.regions.empty());
    EXPECT_TRUE(r.positions.empty());
    EXPECT_TRUE(r.labels.empty());
    EXPECT_TRUE(r.matches.empty());
    EXPECT_TRUE(r.residuals.empty());
  }
  static void expect_at(const TrackResult& r, const RigidTransform& truth) {
    ASSERT_EQ(r.state, TrackState::tracking);
    EXPECT_LT(degrees_between(r.pose.rotation, truth.rotation), 0.6);
    const Vector3 centre = model().centre();
    EXPECT_LT((r.pose * centre - truth * centre).norm(), 0.002);
  }

  const Intrinsics camera_ = synthetic::small_camera();
  Tracker tracker_;
  std::vector<std::byte> storage_;
  std::span<std::byte> block_;
  std::optional<Picture> current_;

 private:
  static std::unique_ptr<Geometry> mesh_;
  static std::unique_ptr<ModelFile> file_;
};
std::unique_ptr<Geometry> TrackerTest::mesh_;
std::unique_ptr<ModelFile> TrackerTest::file_;

TEST_F(TrackerTest, TakesTheModelsMaterialUnlessToldOtherwise) {
  EXPECT_EQ(TrackSettings().material, TrackSettings::kAsInModel);
  std::vector<float> energies;
  for (const double material : {TrackSettings::kAsInModel, model().material(), 0.0}) {
    TrackSettings settings;
    settings.material = material;
    start(settings);
    tracker_.start_from(pose(0));
    float energy = 0;
    for (int frame = 0; frame < 4; ++frame) energy = see(frame).strain_energy;
    energies.push_back(energy);
  }
  EXPECT_EQ(energies[0], energies[1]);
  EXPECT_NE(energies[0], energies[2]);
  TrackSettings settings;
  for (const double wrong : {-0.5, 1.5, std::nan("")}) {
    settings.material = wrong;
    EXPECT_NE(tracker_.start(model(), camera_, SensorDescription(), settings, block_), nullptr) << wrong;
  }
}

TEST_F(TrackerTest, FollowsAMovingObjectFromAGivenPose) {
  start();
  tracker_.start_from(pose(0));
  for (int frame = 0; frame < 12; ++frame) {
    const TrackResult& r = see(frame);
    expect_at(r, pose(frame));
    EXPECT_EQ(r.frame, frame);
    EXPECT_EQ(r.utime, frame * 33333);
    EXPECT_TRUE(r.frame_used);
    ASSERT_EQ(r.labels.size(), model().size());
    ASSERT_EQ(r.positions.size(), model().size());
    ASSERT_EQ(r.matches.size(), model().size());
    ASSERT_EQ(r.residuals.size(), model().size());
    ASSERT_FALSE(r.regions.empty());
    EXPECT_EQ(r.regions[0].id, 0);
    EXPECT_EQ(r.regions[0].parent, -1);
    EXPECT_GT(r.confidence, 0.6F);
    std::size_t observed = 0;
    for (std::size_t i = 0; i < model().size(); ++i) {
      observed += r.labels[i] >= 0 ? 1U : 0U;
      ASSERT_EQ(r.labels[i] >= 0, r.matches[i] >= 0 || r.labels[i] >= 0);
      if (r.labels[i] < 0) continue;
      const Vector3 p = to_vector(r.positions[i]);
      const Point3f& rest = model().positions()[i];
      const Vector3 truth = pose(frame) * to_vector(rest);
      ASSERT_LT((p - truth).norm(), 0.004);
    }
    EXPECT_GT(observed, model().size() / 5);
  }
}

TEST_F(TrackerTest, FindsTheObjectByItself) {
  start();
  int frame = 0;
  while (frame < 30 && see(0).state != TrackState::tracking) ++frame;
  ASSERT_LT(frame, 10);
  expect_at(see(0), pose(0));
}

TEST_F(TrackerTest, IsLostSoonWhenTheObjectIsGoneAndFindsItAgain) {
  start();
  tracker_.start_from(pose(0));
  for (int frame = 0; frame < 4; ++frame) ASSERT_EQ(see(frame).state, TrackState::tracking);
  int still_claimed = 0;
  for (int frame = 4; frame < 24; ++frame) {
    const TrackResult& r = see(frame, false);
    if (r.state == TrackState::tracking) {
      ++still_claimed;
      ASSERT_LT(frame, 9);
    } else {
      EXPECT_EQ(r.state, TrackState::lost);
      expect_nothing(r);
    }
  }
  EXPECT_LE(still_claimed, 4);
  int back = 24;
  while (back < 60 && see(3).state != TrackState::tracking) ++back;
  EXPECT_LT(back - 24, 15);
  expect_at(see(3), pose(3));
}

TEST_F(TrackerTest, IsSearchingBeforeItWasEverFound) {
  start();
  for (int frame = 0; frame < 8; ++frame) {
    const TrackResult& r = see(frame, false);
    EXPECT_EQ(r.state, TrackState::searching);
    expect_nothing(r);
  }
}

TEST_F(TrackerTest, DoesNotUseFramesThatCannotBe) {
  start();
  tracker_.start_from(pose(0));
  ASSERT_EQ(see(0).state, TrackState::tracking);
  const DepthFrame good = current_->frame(0);
  std::vector<DepthFrame> bad(5, good);
  bad[0].depth = nullptr;
  bad[1].width = good.width - 1;
  bad[2].height = good.height + 1;
  bad[3].stride = good.width - 1;
  bad[4].width = bad[4].height = 0;
  for (const DepthFrame& frame : bad) {
    const TrackResult& r = tracker_.process(frame);
    EXPECT_FALSE(r.frame_used);
    expect_nothing(r);
  }
  expect_at(see(1), pose(1));  // they changed nothing
}

TEST_F(TrackerTest, SurvivesWildPictures) {
  start();
  std::vector<std::uint16_t> wild(table_size(camera_.width, camera_.height));
  std::uint32_t state = 1;
  for (int frame = 0; frame < 12; ++frame) {
    for (std::uint16_t& d : wild) {
      state = state * 1664525U + 1013904223U;
      d = static_cast<std::uint16_t>(frame % 3 == 0   ? state >> 16
                                     : frame % 3 == 1 ? 65535
                                                      : 700 + (state >> 28));
    }
    if (frame % 4 == 3) tracker_.start_from(pose(0));
    const TrackResult& r =
        tracker_.process({wild.data(), camera_.width, camera_.height, camera_.width, frame, frame});
    if (r.state != TrackState::tracking) expect_nothing(r);
    for (const Region& region : r.regions) ASSERT_TRUE(region.pose.translation.allFinite());
  }
}

TEST_F(TrackerTest, SurvivesAPoseInTheCamerasPlane) {
  for (const double z : {0.0, -0.7}) {
    start();
    RigidTransform pose;
    pose.translation = Vector3(0, 0, z) - model().centre();
    tracker_.start_from(pose);
    for (int frame = 0; frame < 4; ++frame) EXPECT_NE(see(frame).state, TrackState::tracking);
  }
}

TEST_F(TrackerTest, ForgetsWhenReset) {
  start();
  tracker_.start_from(pose(0));
  ASSERT_EQ(see(0).state, TrackState::tracking);
  tracker_.reset();
  EXPECT_EQ(see(0, false).state, TrackState::searching);
}

TEST_F(TrackerTest, GivesTheSameBytesTwiceAndWithEveryKernel) {
  std::vector<std::string> runs;
  for (const Kernels kernels : {Kernels::automatic, Kernels::automatic, Kernels::scalar, Kernels::sse,
                                Kernels::avx2, Kernels::neon}) {
    TrackSettings settings;
    settings.kernels = kernels;
    start(settings);
    tracker_.start_from(pose(0));
    std::string all;
    for (int frame = 0; frame < 5; ++frame) {
      const TrackResult& r = see(frame, frame != 3);
      const auto add = [&](const auto& span) {
        all.append(reinterpret_cast<const char*>(span.data()), span.size_bytes());
      };
      add(r.positions);
      add(r.labels);
      add(r.matches);
      add(r.residuals);
      all.append(reinterpret_cast<const char*>(r.pose.rotation.data()), 9 * sizeof(double));
    }
    runs.push_back(all);
  }
  for (const std::string& run : runs) EXPECT_TRUE(run == runs[0]);
}

TEST_F(TrackerTest, WorksWithLessUnderLoad) {
  start();
  tracker_.set_work_level(0);
  tracker_.start_from(pose(0));
  for (int frame = 0; frame < 6; ++frame) expect_at(see(frame), pose(frame));
  tracker_.set_work_level(7);  // out of range: as much as there is
  expect_at(see(6), pose(6));
}

TEST_F(TrackerTest, TakesALevelThatIsNoNumberForTheLeast) {
  Vector3 least = Vector3::Zero();
  for (const double level : {0.0, std::nan(""), -1.0}) {
    start();
    tracker_.set_work_level(level);
    tracker_.start_from(pose(0));
    Vector3 at = Vector3::Zero();
    for (int frame = 0; frame < 3; ++frame) {
      const TrackResult& r = see(frame);
      expect_at(r, pose(frame));
      at = r.pose.translation;
    }
    if (level == 0) least = at;
    EXPECT_EQ(at, least) << level;
  }
}

TEST_F(TrackerTest, TellsStagesInOrder) {
  start();
  std::vector<Stage> stages;
  tracker_.observe({[](void* to, Stage s) { static_cast<std::vector<Stage>*>(to)->push_back(s); }, &stages});
  tracker_.start_from(pose(0));
  (void)see(0);
  ASSERT_GE(stages.size(), 6U);
  EXPECT_EQ(stages.back(), Stage::deform);
  EXPECT_NE(std::find(stages.begin(), stages.end(), Stage::surface), stages.end());
  EXPECT_NE(std::find(stages.begin(), stages.end(), Stage::align), stages.end());
}

TEST_F(TrackerTest, SaysInWordsWhyItCannotStart) {
  const TrackSettings settings;
  const std::size_t bytes = Tracker::workspace_bytes(model(), camera_, settings);
  EXPECT_GT(bytes, 1000000U);
  block_ = OwnedWorkspace::aligned(storage_, bytes);
  Tracker t;
  const SensorDescription sensor;
  for (const std::size_t too_few : {std::size_t{0}, std::size_t{64}, bytes / 2, bytes - 64}) {
    const char* fault = t.start(model(), camera_, sensor, settings, block_.first(too_few));
    ASSERT_NE(fault, nullptr) << too_few;
    EXPECT_NE(std::strstr(fault, "too small"), nullptr) << fault;
  }
  EXPECT_NE(t.start(ModelView(), camera_, sensor, settings, block_), nullptr);
  Intrinsics broken = camera_;
  broken.fx = std::nan("");
  EXPECT_NE(t.start(model(), broken, sensor, settings, block_), nullptr);
  SensorDescription odd;
  odd.noise_growth = std::nan("");
  EXPECT_NE(t.start(model(), camera_, odd, settings, block_), nullptr);
  TrackSettings none = settings;
  none.max_regions = 0;
  EXPECT_NE(t.start(model(), camera_, sensor, none, block_), nullptr);
  EXPECT_EQ(t.start(model(), camera_, sensor, settings, block_), nullptr);
}

}  // namespace
}  // namespace pliant

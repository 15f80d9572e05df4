#include "core/track/regroup.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::TrackScene;

/// A bar that bends at its middle, seen from its side.
class Hinge : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { shared_ = std::make_unique<TrackScene>(synthetic::two_part_bar(), 0.005); }
  static void TearDownTestSuite() { shared_.reset(); }
  void SetUp() override {
    scene().points.reset();
    scene().place(pose());
    scene().warp->reset(pose());
    settings_.fewest_points = 40;
  }
  static TrackScene& scene() { return *shared_; }
  static RigidTransform pose() { return synthetic::pose_at({0, 0, 0.6}, {1, 0, 0}, 0.4); }
  static Matrix3 bend(double angle) { return synthetic::turn({0, 1, 0.3}, angle); }

  /// A frame of the bar with its right half turned by `angle` about the hinge.
  bool frame_at(double angle, double noise = 0.001) {
    Picture picture(scene().camera);
    picture.draw(scene().mesh, pose(),
                 [&](const Vector3& p) { return p.x() > 0 ? Vector3(bend(angle) * p) : p; });
    picture.wall(1.5);
    picture.shake(noise, 3);
    scene().see(picture);
    for (TrackedRegion& region : scene().regions) region.predicted = region.last_pose = region.pose;
    scene().align_rounds(4, 12);
    scene().warp_now();
    (void)scene().look_now();
    const Sighting sighting(scene().tables, scene().surface, scene().projector, scene().tolerance);
    return regroup({scene().tables, scene().patches, *scene().warp, sighting, scene().tolerance}, settings_,
                   state_, scene().regions, scene().points);
  }
  void bend_to(double from, double to) {
    for (int step = 0; step <= 20; ++step) (void)frame_at(from + (to - from) * step / 20);
  }
  static std::int64_t alive() {
    return std::count_if(scene().regions.begin(), scene().regions.end(),
                         [](const TrackedRegion& r) { return r.alive; });
  }

  RegroupSettings settings_;
  RegroupState state_;

 private:
  static std::unique_ptr<TrackScene> shared_;
};
std::unique_ptr<TrackScene> Hinge::shared_;

TEST_F(Hinge, MakesTwoRegionsOfHalvesThatMoveApart) {
  for (const double angle : {0.4, -0.4}) {
    SetUp();
    state_ = RegroupState();
    bend_to(0, angle);
    for (int frame = 0; frame < 5; ++frame) (void)frame_at(angle);
    ASSERT_EQ(alive(), 2) << angle;
    // the larger side keeps the base's id: which of the two halves, the sampling decides
    std::size_t wrong = 0, seen = 0, right_of_base = 0, of_base = 0;
    for (std::size_t i = 0; i < scene().tables.size; ++i)
      if (scene().points.home[i] == 0) {
        ++of_base;
        right_of_base += scene().rest(i).x() > 0 ? 1U : 0U;
      }
    const bool base_is_right = 2 * right_of_base > of_base;
    for (std::size_t i = 0; i < scene().tables.size; ++i) {
      const Vector3 rest = scene().rest(i);
      if (scene().points.label[i] < 0 || std::abs(rest.x()) < 0.015) continue;
      ++seen;
      wrong += (scene().points.home[i] == 0) != ((rest.x() > 0) == base_is_right) ? 1U : 0U;
    }
    ASSERT_GT(seen, 300U);
    EXPECT_LT(wrong, seen / 20) << angle;
    const Matrix3 apart = scene().regions[1].pose.rotation * scene().regions[0].pose.rotation.transpose();
    EXPECT_NEAR(synthetic::degrees_between(apart, Matrix3::Identity()), 0.4 * 57.3, 3.0);
    EXPECT_EQ(scene().regions[1].parent, 0);
  }
}

TEST_F(Hinge, PutsRigidPointsWhereTheirRegionPutsThem) {
  bend_to(0, 0.4);
  ASSERT_GE(alive(), 2);
  // in the very frame of a change, too
  for (int frame = 0; frame < 3; ++frame) {
    (void)frame_at(0.4 - 0.1 * frame);
    for (std::size_t i = 0; i < scene().tables.size; ++i) {
      if (scene().points.label[i] < 0) continue;
      ASSERT_EQ(scene().points.label[i], scene().points.home[i]);
      const TrackedRegion& region = scene().regions[static_cast<std::size_t>(scene().points.home[i])];
      ASSERT_TRUE(region.alive);
      const Vector3 expected = region.pose * scene().rest(i) * kUnitsPerMetre;
      const IntPoint p = scene().points.position[i];
      ASSERT_LT((Vector3(p.x, p.y, p.z) - expected).norm(), 4) << i;
    }
  }
}

TEST_F(Hinge, MakesOneRegionOfHalvesThatAreStraightAgain) {
  bend_to(0, 0.4);
  ASSERT_GE(alive(), 2);
  bend_to(0.4, 0);
  for (int frame = 0; frame < 3 * settings_.merge_after && alive() > 1; ++frame) (void)frame_at(0);
  EXPECT_EQ(alive(), 1);
  for (const std::int8_t home : scene().points.home) ASSERT_EQ(home, 0);
}

TEST_F(Hinge, LeavesAStillObjectWhole) {
  for (const double noise : {0.0, 0.001, 0.002})
    for (int frame = 0; frame < 15; ++frame) {
      EXPECT_FALSE(frame_at(0, noise)) << noise << " in frame " << frame;
      ASSERT_EQ(alive(), 1);
    }
}

TEST_F(Hinge, MakesNoMoreRegionsThanAllowed) {
  settings_.max_regions = 1;
  bend_to(0, 0.4);
  EXPECT_EQ(alive(), 1);
}

}  // namespace
}  // namespace pliant

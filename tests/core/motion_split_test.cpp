#include "core/track/motion_split.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/track/regroup.hpp"
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
  void SetUp() override { scene().points.reset(); }
  static TrackScene& scene() { return *shared_; }
  static RigidTransform pose() { return synthetic::pose_at({0, 0, 0.6}, {1, 0, 0}, 0.4); }

  /// Sees the bar with its right half turned by `angle` about the hinge, and aligns the base to the whole.
  static void see_bent(double angle, double noise = 0.001) {
    const Matrix3 bend = synthetic::turn({0, 1, 0.3}, angle);
    Picture picture(scene().camera);
    picture.draw(scene().mesh, pose(), [&](const Vector3& p) { return p.x() > 0 ? Vector3(bend * p) : p; });
    picture.wall(1.5);
    picture.shake(noise, 3);
    scene().see(picture);
    scene().place(pose());
    for (std::size_t i = 0; i < scene().tables.size; ++i) scene().points.home[i] = 0;
    scene().align_rounds(8, 30);
    wide();
  }
  static void wide() {
    AssociateSettings settings;
    settings.points = scene().tables.size;
    settings.gate = 24 * kUnitsPerMillimetre;
    settings.with_deformed = true;
    associate(scene().tables, scene().surface, scene().projector, scene().regions, settings, scene().points);
  }
  static MotionSplitSettings settings() {
    MotionSplitSettings s;
    s.noise = scene().surface.sigma(9600) / kUnitsPerMetre;
    s.moved = 0.0025;
    return s;
  }

 private:
  static std::unique_ptr<TrackScene> shared_;
};
std::unique_ptr<TrackScene> Hinge::shared_;

TEST_F(Hinge, IsFoundWhereTheHalvesMoveApart) {
  for (const double angle : {0.2, -0.2}) {
    see_bent(angle);
    MotionSplit split;
    ASSERT_TRUE(find_motion_split(scene().patches, 0, settings(), scene().points, split)) << angle;
    // patches of the two sides fall apart at the hinge
    std::size_t left_in = 0, left = 0, right_in = 0, right = 0;
    for (std::size_t p = 0; p < scene().patches.count; ++p) {
      if (split.energy[p].points < 4 || std::abs(scene().rest(p).x()) < 0.03) continue;
      const bool in = split.part.has(p);
      (scene().rest(p).x() > 0 ? right : left) += 1;
      (scene().rest(p).x() > 0 ? right_in : left_in) += in ? 1U : 0U;
    }
    ASSERT_GT(left, 6U);
    ASSERT_GT(right, 6U);
    const bool right_is_part = right_in > left_in;
    const std::size_t wrong = right_is_part ? left_in + (right - right_in) : right_in + (left - left_in);
    EXPECT_LE(wrong, (left + right) / 5) << angle;
  }
}

TEST_F(Hinge, IsNotFoundInAStillObject) {
  for (const double noise : {0.0, 0.001, 0.002}) {
    see_bent(0, noise);
    MotionSplit split;
    EXPECT_FALSE(find_motion_split(scene().patches, 0, settings(), scene().points, split)) << noise;
  }
}

TEST_F(Hinge, NeedsReadingsOnBothSides) {
  see_bent(0.2);
  scene().points.correspondence_count = 60;
  MotionSplit split;
  MotionSplitSettings many = settings();
  many.fewest_points = 40;
  EXPECT_FALSE(find_motion_split(scene().patches, 0, many, scene().points, split));
  scene().points.correspondence_count = 0;
  EXPECT_FALSE(find_motion_split(scene().patches, 0, many, scene().points, split));
}

TEST_F(Hinge, BecomesARegionThatIsMergedOnceStraightAgain) {
  RegroupState state;
  MotionSplit scratch;
  RegroupSettings regroup_settings;
  regroup_settings.fewest_points = 40;
  const RegroupContext context{scene().tables, scene().patches, scene().surface, scene().projector,
                               scene().tolerance};
  const auto alive = [] {
    return std::count_if(scene().regions.begin(), scene().regions.end(),
                         [](const TrackedRegion& r) { return r.alive; });
  };
  see_bent(0.2);
  for (int frame = 0; frame < 8 && alive() == 1; ++frame) {
    (void)scene().label_now();
    wide();
    (void)regroup(context, regroup_settings, state, scratch, scene().regions, scene().points);
  }
  ASSERT_EQ(alive(), 2);
  const TrackedRegion& part = scene().regions[1];
  EXPECT_EQ(part.parent, 0);
  EXPECT_GT(synthetic::degrees_between(part.pose.rotation, scene().regions[0].pose.rotation), 5.0);
  const Joint joint = joint_of(scene().tables, scene().points, 1, 0);
  EXPECT_GT(joint.edges, 8U);
  EXPECT_LT(std::abs(joint.centre.x()), 0.03);
  EXPECT_EQ(joint_of(scene().tables, scene().points, 1, 5).edges, 0U);

  // straight again: both move alike for long enough
  scene().see_body(pose());
  for (TrackedRegion& region : scene().regions)
    if (region.alive) region.pose = region.predicted = pose();
  for (int frame = 0; frame < 3 * regroup_settings.merge_after && alive() == 2; ++frame) {
    (void)scene().label_now();
    wide();
    (void)regroup(context, regroup_settings, state, scratch, scene().regions, scene().points);
  }
  EXPECT_EQ(alive(), 1);
  for (const std::int8_t home : scene().points.home) ASSERT_EQ(home, 0);
}

TEST_F(Hinge, MakesNoMoreRegionsThanAllowed) {
  RegroupState state;
  MotionSplit scratch;
  RegroupSettings one;
  one.max_regions = 1;
  const RegroupContext context{scene().tables, scene().patches, scene().surface, scene().projector,
                               scene().tolerance};
  see_bent(0.25);
  for (int frame = 0; frame < 10; ++frame) {
    (void)scene().label_now();
    wide();
    EXPECT_FALSE(regroup(context, one, state, scratch, scene().regions, scene().points));
  }
  for (std::size_t k = 1; k < scene().regions.size(); ++k) EXPECT_FALSE(scene().regions[k].alive);
}

}  // namespace
}  // namespace pliant

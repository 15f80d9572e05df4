#include "core/track/regroup.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/hinge.hpp"

namespace pliant {
namespace {

using synthetic::Picture;

using synthetic::Hinge;

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

TEST_F(Hinge, PutsRigidPointsWhereTheirRegionPutsThemOrAsFarToTheWarpAsTheLimitAllows) {
  bend_to(0, 0.4);
  ASSERT_GE(alive(), 2);
  // in the very frame of a change, too
  for (int frame = 0; frame < 3; ++frame) {
    (void)frame_at(0.4 - 0.1 * frame);
    const WarpLanes lanes = lanes_of(scene().patches, *scene().warp);
    for (std::size_t i = 0; i < scene().tables.size; ++i) {
      if (scene().points.label[i] < 0) continue;
      ASSERT_EQ(scene().points.label[i], scene().points.home[i]);
      const TrackedRegion& region = scene().regions[static_cast<std::size_t>(scene().points.home[i])];
      ASSERT_TRUE(region.alive);
      const Vector3 rigid = region.pose * scene().rest(i) * kUnitsPerMetre;
      const IntPoint w = warped_point(scene().tables, scene().patches, lanes, i),
                     p = scene().points.position[i];
      const Vector3 apart = Vector3(w.x, w.y, w.z) - rigid;
      const double limit = scene().tolerance.deformed(static_cast<std::int32_t>(rigid.z()));
      const double share = std::min(apart.norm(), limit) / std::max(apart.norm(), limit);
      // off the model along the normal, which the warp may have turned
      const RigidTransform& patch = scene().warp->pose[scene().patches.patch_of[i]];
      const auto at = [&](const RigidTransform& pose) -> Vector3 {
        return Vector3(p.x, p.y, p.z) - rigid - scene().model_error_at(i) * scene().normal(pose, i);
      };
      // regions that came, went or took points over put them where they say
      ASSERT_LT(std::min({at(region.pose).norm(), (at(region.pose) - share * apart).norm(),
                          (at(patch) - share * apart).norm()}),
                4)
          << i;
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

TEST_F(Hinge, OneFrameMakesNoPart) {
  settings_.split_after = 1000;
  bend_to(0, 0.4);
  ASSERT_EQ(alive(), 1);
  settings_ = RegroupSettings();
  state_ = RegroupState();
  for (int frame = 1; frame < settings_.split_after; ++frame)
    EXPECT_FALSE(frame_at(0.4)) << "after " << frame;
  EXPECT_EQ(state_.suspected[0], settings_.split_after - 1);
  EXPECT_TRUE(frame_at(0.4));
  EXPECT_EQ(alive(), 2);
}

TEST_F(Hinge, MakesNoMoreRegionsThanAllowed) {
  settings_.max_regions = 1;
  bend_to(0, 0.4);
  EXPECT_EQ(alive(), 1);
}

TEST_F(Hinge, TheLargestBodyBecomesTheBaseWhenItHasShrunk) {
  (void)frame_at(0);
  scene().regions[1] = scene().regions[0];
  scene().regions[1].parent = 0;
  scene().regions[2] = scene().regions[0];
  scene().regions[2].parent = 1;
  settings_.fewest_points = 8;
  double left = 0;
  for (std::size_t i = 0; i < scene().tables.size; ++i) left = std::min(left, scene().rest(i).x());
  for (std::size_t i = 0; i < scene().tables.size; ++i) {
    const double x = scene().rest(i).x();
    scene().points.home[i] = x < 0.8 * left    ? std::int8_t{0}
                             : x < -0.8 * left ? std::int8_t{1}
                                               : std::int8_t{2};
  }
  const auto at = [&](double x) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < scene().tables.size; ++i)
      if (std::abs(scene().rest(i).x() - x) < std::abs(scene().rest(nearest).x() - x)) nearest = i;
    return static_cast<int>(scene().points.home[nearest]);
  };
  ASSERT_EQ(at(0), 1);
  bool changed = false;
  for (int frame = 0; frame < settings_.merge_after && !changed; ++frame) {
    EXPECT_EQ(at(0), 1) << "too early";
    changed = frame_at(0);
  }
  ASSERT_TRUE(changed);
  EXPECT_EQ(at(0), 0);
  EXPECT_EQ(scene().regions[0].parent, -1);
  EXPECT_EQ(scene().regions[1].parent, 0);
  EXPECT_EQ(scene().regions[2].parent, 0);
}

TEST_F(Hinge, OfWhatSplitsTheLargerStaysTheBase) {
  // three quarters of the bar have turned, with the warp; the base, which is not aligned here, is the rest
  const std::size_t left = end_of_bar(-1), right = end_of_bar(1);
  const Vector3 hinge(0.5 * scene().rest(left).x(), 0, 0);
  const Matrix3 turn = bend(0.2);
  Picture picture(scene().camera);
  picture.draw(scene().mesh, pose(),
               [&](const Vector3& p) { return p.x() > hinge.x() ? Vector3(hinge + turn * (p - hinge)) : p; });
  picture.wall(1.5);
  scene().see(picture);
  for (std::size_t p = 0; p < scene().patches.count; ++p)
    if (scene().patches.centres[p].x() > hinge.x())
      scene().warp->pose[p] = pose() * RigidTransform{turn, hinge - turn * hinge};
  for (int frame = 0; frame < settings_.split_after && alive() == 1; ++frame) {
    scene().warp_now();
    (void)scene().look_now();
    (void)regroup_now();
  }
  ASSERT_EQ(alive(), 2);
  EXPECT_EQ(scene().points.home[right], 0);
  EXPECT_EQ(scene().points.home[left], 1);
  EXPECT_EQ(scene().regions[0].parent, -1);
  EXPECT_EQ(scene().regions[1].parent, 0);
}

TEST_F(Hinge, ABaseThatSomethingHidesStaysTheBase) {
  bend_to(0, 0.4);
  ASSERT_EQ(alive(), 2);
  const std::size_t right_end = end_of_bar(1);
  if (scene().points.home[right_end] != 0) {
    std::swap(scene().regions[0], scene().regions[1]);
    scene().regions[0].parent = -1;
    scene().regions[1].parent = 0;
    for (std::int8_t& home : scene().points.home) home = home == 0 ? std::int8_t{1} : std::int8_t{0};
  }
  const int just_right_of_the_hinge = scene().camera.width * 9 / 16;
  for (int frame = 0; frame < 2 * settings_.merge_after; ++frame)
    (void)frame_at(0.4, 0.001, just_right_of_the_hinge);
  std::size_t base = 0, rigid = 0;
  for (const std::int8_t label : scene().points.label) {
    base += label == 0 ? 1U : 0U;
    rigid += label >= 0 ? 1U : 0U;
  }
  EXPECT_LT(base * 4, rigid);
  EXPECT_EQ(scene().points.home[right_end], 0);
}

TEST_F(Hinge, DissolvesARegionThatTearsOff) {
  bend_to(0, 0.4);
  ASSERT_EQ(alive(), 2);
  scene().regions[1].pose.translation.z() -= 0.15;
  (void)frame_at(0.4);
  EXPECT_EQ(alive(), 1);
  for (const std::int8_t home : scene().points.home) ASSERT_EQ(home, 0);
}

}  // namespace
}  // namespace pliant

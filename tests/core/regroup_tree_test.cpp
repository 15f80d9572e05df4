// Regions that nobody sees, and what hangs on what when regions go.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/core/hinge.hpp"

namespace pliant {
namespace {

using synthetic::Hinge;

/// Regions side by side along the bar, of equal length, all where the bar is.
class RegionTree : public Hinge {
 protected:
  void lie_along(const std::vector<std::int8_t>& ids, const std::vector<std::int8_t>& parents) {
    (void)frame_at(0);
    settings_.fewest_points = 8;
    double left = 0;
    for (std::size_t i = 0; i < scene().tables.size; ++i) left = std::min(left, scene().rest(i).x());
    for (std::size_t i = 0; i < scene().tables.size; ++i) {
      const double along = (scene().rest(i).x() - left) / (-2.0001 * left);
      const double place = std::clamp(along, 0.0, 0.9999) * static_cast<double>(ids.size());
      scene().points.home[i] = ids[static_cast<std::size_t>(place)];
    }
    for (std::size_t k = 1; k < parents.size(); ++k) {
      scene().regions[k] = scene().regions[0];
      scene().regions[k].parent = parents[k];
    }
  }
  static void expect_a_tree() {
    for (std::size_t k = 0; k < scene().regions.size(); ++k) {
      if (!scene().regions[k].alive) continue;
      int steps = 0;
      auto at = static_cast<std::int8_t>(k);
      for (; at > 0 && steps < 9; ++steps) {
        at = scene().regions[static_cast<std::size_t>(at)].parent;
        if (at > 0) {
          ASSERT_TRUE(scene().regions[static_cast<std::size_t>(at)].alive);
        }
      }
      EXPECT_EQ(at, 0) << "region " << k;
    }
    for (const std::int8_t home : scene().points.home)
      ASSERT_TRUE(scene().regions[static_cast<std::size_t>(home)].alive);
  }
};

TEST_F(RegionTree, WhatNobodySeesStaysARegion) {
  lie_along({0, 0, 1}, {-1, 0});
  for (int frame = 0; frame < 3 * settings_.merge_after; ++frame) {
    (void)frame_at(0, 0.001, 160);
    ASSERT_EQ(alive(), 2) << frame;
  }
  bool changed = false;
  for (int frame = 0; frame < settings_.merge_after && !changed; ++frame) changed = frame_at(0);
  EXPECT_EQ(alive(), 1) << "as soon as it is seen to move alike";
}

TEST_F(RegionTree, WhatHungOnARegionThatMergesIntoItsGrandchildHangsOnThat) {
  lie_along({0, 3, 1, 2}, {-1, 3, 0, 2});  // 1 hangs on 3, 3 on 2, 2 on 0
  bool changed = false;
  for (int frame = 0; frame < settings_.merge_after && !changed; ++frame) changed = frame_at(0);
  ASSERT_TRUE(changed);
  ASSERT_FALSE(scene().regions[2].alive);
  EXPECT_EQ(scene().regions[1].parent, 0);
  EXPECT_EQ(scene().regions[3].parent, 1);
  for (int frame = 0; frame < 4 * settings_.merge_after; ++frame) {
    (void)frame_at(0);
    expect_a_tree();
  }
  EXPECT_EQ(alive(), 1);
}

TEST_F(RegionTree, WhatNobodySeesStaysWhereItIsWhenWhatItHangsOnGoes) {
  lie_along({0, 1, 2}, {-1, 0, 1});
  TrackedRegion& hidden = scene().regions[2];
  hidden.frames_unseen = 3;
  hidden.from_parent.rotation = bend(0.3);
  TrackedRegion& torn = scene().regions[1];
  torn.pose.translation.z() -= 0.15;
  const RigidTransform before = torn.pose * hidden.from_parent;
  ASSERT_TRUE(frame_at(0, 0.001, 190));
  ASSERT_FALSE(torn.alive);
  ASSERT_EQ(hidden.parent, 0);
  // the region that tore off was followed once more before it went
  const RigidTransform after = scene().regions[0].pose * hidden.from_parent;
  EXPECT_LT((after.translation - before.translation).norm(), 0.03);
  EXPECT_LT(synthetic::degrees_between(after.rotation, before.rotation), 10);
}

TEST_F(RegionTree, PointsOfARegionThatWentStayWhereTheyAreSeen) {
  bend_to(0, 0.4);
  ASSERT_EQ(alive(), 2);
  (void)frame_at(0.4);
  const std::vector<std::int8_t> labels(scene().points.label.begin(), scene().points.label.end());
  const std::vector<IntPoint> before(scene().points.position.begin(), scene().points.position.end());
  settings_.fewest_points = 100'000;  // too small to be a region any more
  ASSERT_TRUE(frame_at(0.4));
  ASSERT_EQ(alive(), 1);
  const Sighting sighting(scene().tables, scene().surface, scene().projector, scene().tolerance);
  const RegionPoses poses = fixed_poses(scene().regions, scene().tables.centre);
  std::size_t deformed = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] != 1 || scene().points.label[i] == kNotObserved) continue;
    if (scene().points.label[i] == 0) {
      const Sighting::Look look = sighting.look(i, poses[0]);
      ASSERT_EQ(look.sight, Sight::agrees);
      EXPECT_EQ(scene().points.residual[i], look.residual - scene().model_error_at(i));
      EXPECT_EQ(scene().points.match[i], look.match);
      continue;
    }
    const IntPoint &a = before[i], &b = scene().points.position[i];
    ASSERT_LT(Vector3(a.x - b.x, a.y - b.y, a.z - b.z).norm(), 4 * kUnitsPerMillimetre);
    ++deformed;
  }
  EXPECT_GT(deformed, 300U);
}

TEST_F(RegionTree, APartThatSlidAlongItsNeighboursSurfaceIsTheNeighbours) {
  bend_to(0, 0.4);
  ASSERT_EQ(alive(), 2);
  for (int frame = 0; frame < 5; ++frame) (void)frame_at(0.4);
  // Right of the hinge there is a piece that still counts to the left half; the warp has it where the right
  // one puts it, but for what nobody can see.
  const auto farthest =
      std::max_element(scene().patches.centres.begin(),
                       scene().patches.centres.begin() + static_cast<std::ptrdiff_t>(scene().patches.count),
                       [](const Vector3& a, const Vector3& b) { return a.x() < b.x(); });
  const std::int8_t right =
      scene().warp->home[static_cast<std::size_t>(farthest - scene().patches.centres.begin())];
  const auto left = static_cast<std::int8_t>(1 - right);
  RigidTransform slid;
  slid.translation = Vector3(0.004, 0, 0);
  slid = scene().regions[static_cast<std::size_t>(right)].pose * slid;
  std::size_t pieces = 0;
  for (std::size_t p = 0; p < scene().patches.count; ++p) {
    if (scene().warp->home[p] != right || scene().patches.centres[p].x() < 0.06) continue;
    ++pieces;
    scene().warp->home[p] = left;
    scene().warp->pose[p] = slid;
    for (std::size_t i = 0; i < scene().tables.size; ++i)
      if (scene().patches.patch_of[i] == p) scene().points.home[i] = left;
  }
  ASSERT_GT(pieces, 8U);
  for (int round = 0; round < settings_.split_after + 1; ++round) (void)regroup_now();
  EXPECT_EQ(alive(), 2);
  for (std::size_t p = 0; p < scene().patches.count; ++p)
    if (scene().patches.centres[p].x() > 0.08 && patch_counts(*scene().warp, p)) {
      EXPECT_EQ(scene().warp->home[p], right);
    }
}

TEST_F(RegionTree, NothingIsLeftOfTheEvidenceForARegionThatWent) {
  bend_to(0, 0.4);
  ASSERT_EQ(alive(), 2);
  for (std::size_t i = 0; i < scene().tables.size; ++i) {
    if (scene().points.home[i] != 0) continue;
    scene().points.rival[i] = 1;
    scene().points.switching[i] = 9;
  }
  scene().regions[1].pose.translation.z() -= 0.15;
  (void)frame_at(0.4);
  ASSERT_EQ(alive(), 1);
  for (const std::int8_t rival : scene().points.rival) ASSERT_NE(rival, 1);
}

}  // namespace
}  // namespace pliant

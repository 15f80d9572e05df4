#include "core/track/undecided.hpp"

#include <gtest/gtest.h>

#include "core/track/borders.hpp"
#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::TrackScene;

/// A bar whose right half is turned about its middle, with a region for each half.
class Undecided : public ::testing::Test {
 protected:
  void SetUp() override {
    const RigidTransform left = synthetic::pose_at({0, 0, 0.6}, {1, 0, 0}, 0.4);
    const Matrix3 bend = synthetic::turn({0, 1, 0.3}, 0.3);
    scene_.place(left);
    scene_.regions[1] = scene_.regions[0];
    scene_.regions[1].pose.rotation = left.rotation * bend;
    Picture picture(scene_.camera);
    picture.draw(scene_.mesh, left, [&](const Vector3& p) { return p.x() > 0 ? Vector3(bend * p) : p; });
    picture.wall(1.5);
    scene_.see(picture);
    for (std::size_t i = 0; i < scene_.tables.size; ++i) {
      scene_.points.home[i] = home_of(i);
      scene_.points.sight[i] = Sight::agrees;
    }
  }
  std::int8_t home_of(std::size_t i) const {
    return scene_.rest(i).x() > 0 ? std::int8_t{1} : std::int8_t{0};
  }
  void settle() {
    const Sighting sighting(scene_.tables, scene_.surface, scene_.projector, scene_.tolerance);
    settle_undecided(scene_.tables, scene_.patches, region_borders(scene_.patches, scene_.points.home),
                     sighting, scene_.regions, scene_.points);
  }
  std::size_t wrong(double from, double to) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < scene_.tables.size; ++i) {
      const double x = scene_.rest(i).x();
      count += x > from && x < to && scene_.points.home[i] != home_of(i) ? 1U : 0U;
    }
    return count;
  }

  TrackScene scene_{synthetic::two_part_bar(), 0.005};
};

TEST_F(Undecided, PointsBesideAJointGoWithTheNearestDecidedOnes) {
  std::size_t given = 0;
  const Sighting sighting(scene_.tables, scene_.surface, scene_.projector, scene_.tolerance);
  const FixedPose left(scene_.regions[0].pose, scene_.tables.centre);
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    const double x = scene_.rest(i).x();
    if (x < 0.003 || x > 0.03 || sighting.look(i, left).sight != Sight::agrees) continue;
    scene_.points.home[i] = 0;  // where the other region's motion is as good within the noise
    ++given;
  }
  ASSERT_GT(given, 10U);
  settle();
  EXPECT_LT(wrong(0, 1), given * 7 / 10);
  EXPECT_EQ(wrong(-1, -0.03), 0U);
}

TEST_F(Undecided, LeavesDecidedAndDeformedPointsAlone) {
  settle();
  EXPECT_EQ(wrong(0.05, 1), 0U);
  EXPECT_EQ(wrong(-1, -0.05), 0U);
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    scene_.points.home[i] = 0;
    scene_.points.evidence[i] = kEvidenceMax;
  }
  settle();
  for (std::size_t i = 0; i < scene_.tables.size; ++i) ASSERT_EQ(scene_.points.home[i], 0);
}

TEST_F(Undecided, OneRegionHasNothingToSettle) {
  scene_.regions[1].alive = false;
  for (std::int8_t& home : scene_.points.home) home = 0;
  settle();
  for (std::size_t i = 0; i < scene_.tables.size; ++i) ASSERT_EQ(scene_.points.home[i], 0);
}

}  // namespace
}  // namespace pliant

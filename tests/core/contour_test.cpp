#include "core/track/contour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::TrackScene;

constexpr std::int32_t kReach = 20 * kUnitsPerMillimetre;

/// A bar across the picture, 0.6 m away.
class Contour : public ::testing::Test {
 protected:
  struct Found {
    std::vector<std::int32_t> above, below;  // distances at the upper and the lower edge, 1/16 mm
    std::size_t rim = 0, upper_middle = 0;  // the latter: answers at the upper edge where the shadow may fall
  };

  /// The bar is drawn `shift` (metres) beside where its pose has it, before `more`.
  /// Points nearer than `nearest` (1/16 mm) are not asked.
  Found look(const Vector3& shift, double wall = 1.5, std::int32_t nearest = 0) {
    Picture picture(scene_.camera);
    RigidTransform moved = pose_;
    moved.translation += shift;
    picture.draw(scene_.mesh, moved);
    picture.wall(wall);
    // the upper edge, in the shadow of a thing beside it
    if (shadow_) picture.block(150, 0, 164, 100, 0);
    if (shadow_) picture.block(164, 0, 190, scene_.camera.height, 0.4);
    if (cover_) picture.block(0, 0, scene_.camera.width, scene_.camera.height, 0.4);
    scene_.see(picture);
    const FixedPose fixed(pose_, scene_.tables.centre);
    Found found;
    for (std::size_t i = 0; i < scene_.tables.size; ++i) {
      const ModelTables& t = scene_.tables;
      const IntPoint at = fixed.point(t.x[i], t.y[i], t.z[i]),
                     normal = fixed.direction(t.nx[i], t.ny[i], t.nz[i]);
      if (at.z < nearest || !on_rim(at, normal) || std::abs(normal.y) < 15000) continue;  // the long edges
      ++found.rim;
      std::int32_t distance = 0;
      if (find_contour(scene_.surface, scene_.projector, {kReach, kReach}, at, normal, distance))
        (normal.y < 0 ? found.above : found.below).push_back(distance);
      else
        continue;
      int u = 0, v = 0;
      if (normal.y < 0 && scene_.projector.project(at, u, v) && u >= 152 && u < 162) ++found.upper_middle;
    }
    return found;
  }
  static std::int32_t median(std::vector<std::int32_t> of) {
    const auto middle = of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2);
    std::nth_element(of.begin(), middle, of.end());
    return *middle;
  }
  /// A pixel there, 1/16 mm.
  [[nodiscard]] std::int32_t pixel() const {
    return static_cast<std::int32_t>(scene_.projector.length(256, 600 * kUnitsPerMillimetre));
  }

  TrackScene scene_{synthetic::two_part_bar(), 0.004};
  RigidTransform pose_ = synthetic::pose_at({0, 0, 0.6}, {1, 0, 0}, 0.0);
  bool cover_ = false, shadow_ = false;
};

TEST_F(Contour, LiesOnTheRimWhereTheObjectIs) {
  const Found found = look(Vector3::Zero());
  ASSERT_GT(found.above.size(), 10U);
  ASSERT_GT(found.below.size(), 10U);
  EXPECT_LE(std::abs(median(found.above)), pixel());
  EXPECT_LE(std::abs(median(found.below)), pixel());
}

TEST_F(Contour, MovesAlongTheNormalWithTheObjectOutwardsAndInwards) {
  constexpr std::int32_t kShift = 8 * kUnitsPerMillimetre;
  const Found still = look(Vector3::Zero()), moved = look({0, 0.008, 0});
  ASSERT_GT(moved.above.size(), 10U);
  ASSERT_GT(moved.below.size(), 10U);
  EXPECT_NEAR(median(moved.above) - median(still.above), -kShift, pixel());
  EXPECT_NEAR(median(moved.below) - median(still.below), kShift, pixel());
}

TEST_F(Contour, IsNotSeenBeyondReachOrWithoutABackground) {
  const Found away = look({0, 0.03, 0});
  EXPECT_LE(away.above.size(), 1U) << "30 mm inwards, 20 are looked at";
  const Found before_a_wall = look(Vector3::Zero(), 0.605, 590 * kUnitsPerMillimetre);
  EXPECT_GT(before_a_wall.rim, 10U);
  EXPECT_EQ(before_a_wall.above.size() + before_a_wall.below.size(), 0U);
}

TEST_F(Contour, IsNotSeenBehindSomethingNearer) {
  cover_ = true;
  const Found found = look(Vector3::Zero());
  EXPECT_GT(found.rim, 20U);
  EXPECT_EQ(found.above.size() + found.below.size(), 0U);
}

TEST_F(Contour, IsNotSeenInAShadow) {
  const Found open = look(Vector3::Zero());
  ASSERT_GT(open.upper_middle, 3U);
  shadow_ = true;
  const Found shaded = look(Vector3::Zero());
  EXPECT_EQ(shaded.upper_middle, 0U);
  EXPECT_GT(shaded.above.size(), 10U) << "elsewhere it is";
}

TEST_F(Contour, TheRimIsWhereTheSurfaceTurnsAway) {
  const IntPoint at{0, 0, 600 * kUnitsPerMillimetre};
  EXPECT_TRUE(on_rim(at, {16384, 0, 0}));
  EXPECT_TRUE(on_rim(at, {0, -16135, 2845}));    // 10° behind
  EXPECT_FALSE(on_rim(at, {0, -15396, 5604}));   // 20° behind
  EXPECT_FALSE(on_rim(at, {0, -15396, -5604}));  // 20° before
  EXPECT_FALSE(on_rim(at, {0, 0, -16384}));
}

}  // namespace
}  // namespace pliant

#include "core/deform/radius_search.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "core/memory/row_major.hpp"
#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::TrackScene;
using synthetic::usual_pose;

/// The half beyond x = 3 cm caves in; enough frames to be sure of it.
class RadiusSearch : public ::testing::Test {
 protected:
  void SetUp() override {
    Picture picture(scene_.camera);
    picture.draw(scene_.mesh, usual_pose(), &RadiusSearch::dented);
    picture.wall(1.6);
    scene_.see(picture);
    scene_.place(usual_pose());
    for (int i = 0; i < 5; ++i) (void)scene_.label_now();
    taken_.resize((table_size(scene_.camera.width, scene_.camera.height) + 31) / 32);
  }
  static Vector3 dented(const Vector3& p) {
    return p * (1 - 0.3 * std::clamp((p.x() - 0.03) * 50, 0.0, 1.0));
  }
  void search() {
    search_deformed(scene_.tables, scene_.surface, scene_.projector, 50 * kUnitsPerMillimetre, taken_,
                    scene_.points);
  }

  TrackScene scene_{synthetic::bumpy_body()};
  std::vector<std::uint32_t> taken_;
};

TEST_F(RadiusSearch, MatchesReadingsThatNoRigidPointHas) {
  search();
  std::set<std::int32_t> rigid;
  for (std::size_t i = 0; i < scene_.tables.size; ++i)
    if (scene_.points.label[i] >= 0) rigid.insert(scene_.points.match[i]);
  std::size_t deformed = 0, matched = 0;
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    if (scene_.points.label[i] != kDeformed) continue;
    ++deformed;
    if (scene_.points.match[i] < 0) continue;
    ++matched;
    ASSERT_EQ(rigid.count(scene_.points.match[i]), 0U);
    const int u = scene_.points.match[i] % scene_.camera.width,
              v = scene_.points.match[i] / scene_.camera.width;
    ASSERT_GT(scene_.surface.depth(u, v), 0);
  }
  ASSERT_GT(deformed, 80U);
  EXPECT_GT(matched, deformed / 2);
}

TEST_F(RadiusSearch, MatchesWithinTheRadiusAndSaysHowFar) {
  search();
  std::size_t matched = 0;
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    if (scene_.points.label[i] != kDeformed || scene_.points.match[i] < 0) continue;
    ++matched;
    const int u = scene_.points.match[i] % scene_.camera.width,
              v = scene_.points.match[i] / scene_.camera.width;
    const IntPoint q = scene_.surface.vertex(u, v, scene_.surface.depth(u, v)), p = scene_.points.position[i];
    const double away = Vector3(q.x - p.x, q.y - p.y, q.z - p.z).norm();
    ASSERT_LE(away, 50 * kUnitsPerMillimetre + 1);
    ASSERT_NEAR(scene_.points.residual[i], away, 2);
  }
  EXPECT_GT(matched, 40U);
}

TEST_F(RadiusSearch, LeavesRigidPointsWhereTheyAre) {
  const std::vector<IntPoint> before(scene_.points.position.begin(), scene_.points.position.end()),
      offsets(scene_.points.offset.begin(), scene_.points.offset.end());
  search();
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    if (scene_.points.label[i] < 0) continue;
    ASSERT_EQ(scene_.points.position[i].x, before[i].x);
    ASSERT_EQ(scene_.points.position[i].z, before[i].z);
    ASSERT_EQ(scene_.points.offset[i].z, offsets[i].z);
  }
}

TEST_F(RadiusSearch, GivesNoMatchWithoutReadings) {
  Picture empty(scene_.camera);
  scene_.see(empty);
  for (std::size_t i = 0; i < scene_.tables.size; ++i)
    if (scene_.points.label[i] >= 0) scene_.points.label[i] = kNotObserved;
  search();
  for (std::size_t i = 0; i < scene_.tables.size; ++i)
    if (scene_.points.label[i] == kDeformed) {
      ASSERT_EQ(scene_.points.match[i], -1);
    }
}

}  // namespace
}  // namespace pliant

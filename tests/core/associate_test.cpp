#include "core/track/associate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::usual_pose;

class Associate : public synthetic::SharedScene<synthetic::bumpy_body> {
 protected:
  void SetUp() override {
    scene().points.reset();
    scene().place(usual_pose());
    scene().see_body(usual_pose());
  }

  std::size_t run(std::int32_t gate, std::size_t most = SIZE_MAX) {
    associate(scene().tables, scene().surface, scene().projector, scene().regions,
              for_every_region(SearchReach{most, gate}), scene().points);
    return scene().points.correspondence_count;
  }
};

TEST_F(Associate, FindsTheVisibleSurfaceAtTheTruePose) {
  const std::size_t count = run(20 * kUnitsPerMillimetre);
  EXPECT_GT(count, scene().tables.size / 5);
  EXPECT_LT(count, scene().tables.size * 6 / 10);
  double square = 0;
  for (const Correspondence& c : scene().points.correspondences.first(count)) {
    square += (c.residual / 256.0) * (c.residual / 256.0);
    // where double precision puts the point, and its normal towards the camera
    const Vector3 p = usual_pose() * scene().rest(c.index) * kUnitsPerMetre;
    ASSERT_LT((p - Vector3(c.point.x, c.point.y, c.point.z)).norm(), 3);
    ASSERT_LT(p.dot(Vector3(c.nx, c.ny, c.nz)), 0);
    ASSERT_EQ(c.region, 0);
  }
  EXPECT_LT(std::sqrt(square / static_cast<double>(count)), 1.2);  // millimetres, the picture's own rounding
}

TEST_F(Associate, LooksAtAPrefixPatchByPatch) {
  const std::size_t all = run(20 * kUnitsPerMillimetre);
  const std::size_t some = run(20 * kUnitsPerMillimetre, 500);
  EXPECT_LT(some, all);
  EXPECT_GT(some, 50U);
  for (std::size_t i = 0; i < some; ++i) {
    const std::size_t here = scene().points.correspondences[i].index;
    EXPECT_LT(here, 500U);
    if (i == 0) continue;
    const std::size_t before = scene().points.correspondences[i - 1].index;
    const auto place = [](std::size_t point) { return std::pair(scene().patches.patch_of[point], point); };
    EXPECT_LT(place(before), place(here));
  }
}

TEST_F(Associate, PutsEveryPointUnderItsOwnRegion) {
  // Homes that change from point to point, so that a patch has points of both.
  RegionSet& regions = scene().regions;
  regions[1] = regions[0];
  regions[1].pose.translation.z() += 0.003;
  for (std::size_t i = 0; i < scene().tables.size; ++i) scene().points.home[i] = i % 3 == 0 ? 1 : 0;
  const std::size_t count = run(20 * kUnitsPerMillimetre);
  const RegionPoses poses = fixed_poses(regions, scene().tables.centre);
  std::array<std::size_t, 2> of{};
  for (std::size_t k = 0; k < count; ++k) {
    const Correspondence& c = scene().points.correspondences[k];
    const std::size_t i = c.index, region = i % 3 == 0 ? 1 : 0;
    ASSERT_EQ(static_cast<std::size_t>(c.region), region);
    const ModelTables& t = scene().tables;
    const IntPoint point = poses[region].point(t.x[i], t.y[i], t.z[i]);
    ASSERT_EQ(c.point.x, point.x);
    ASSERT_EQ(c.point.y, point.y);
    ASSERT_EQ(c.point.z, point.z);
    ++of[region];
  }
  EXPECT_GT(of[0], 100U);
  EXPECT_GT(of[1], 100U);
}

TEST_F(Associate, TakesNothingBeyondTheGate) {
  RigidTransform off = usual_pose();
  off.translation.z() += 0.015;
  scene().place(off);
  EXPECT_GT(run(30 * kUnitsPerMillimetre), scene().tables.size / 5);
  const std::size_t few = run(5 * kUnitsPerMillimetre);
  EXPECT_LT(few, scene().tables.size / 20);
  for (const Correspondence& c : scene().points.correspondences.first(few))
    EXPECT_LE(std::abs(c.residual), 5 * 256);
}

TEST_F(Associate, DoesNotMatchWhatHidesTheObject) {
  const std::size_t free_count = run(20 * kUnitsPerMillimetre);
  Picture picture(scene().camera);
  picture.draw(scene().mesh, usual_pose());
  picture.wall(1.6);
  picture.block(0, 0, 165, 240, 0.5);  // the left half
  scene().see(picture);
  const std::size_t count = run(20 * kUnitsPerMillimetre);
  EXPECT_LT(count, free_count * 8 / 10);
  EXPECT_GT(count, free_count / 10);
  for (const Correspondence& c : scene().points.correspondences.first(count)) EXPECT_GT(c.point.z, 9000);
}

TEST_F(Associate, LeavesOutDeformedPoints) {
  const std::size_t all = run(20 * kUnitsPerMillimetre);
  for (std::size_t i = 0; i < scene().tables.size; i += 2) scene().points.evidence[i] = kEvidenceDeformed;
  const std::size_t half = run(20 * kUnitsPerMillimetre);
  EXPECT_LT(half, all * 6 / 10);
  EXPECT_GT(half, all * 4 / 10);
  for (const Correspondence& c : scene().points.correspondences.first(half)) EXPECT_EQ(c.index % 2, 1);
}

TEST_F(Associate, TakesEachPointUnderItsOwnRegion) {
  const std::size_t all = run(20 * kUnitsPerMillimetre);
  scene().regions[1] = scene().regions[0];
  for (std::size_t i = 0; i < 600; ++i) scene().points.home[i] = 1;
  // a part is held at its outline, too
  const std::size_t with_outline = run(20 * kUnitsPerMillimetre);
  EXPECT_GT(with_outline, all);
  for (const Correspondence& c : scene().points.correspondences.first(with_outline))
    ASSERT_EQ(c.region, c.index < 600 ? 1 : 0);
}

TEST_F(Associate, LooksForNoRegionWithoutPoints) {
  scene().regions[1] = scene().regions[0];
  for (std::size_t i = 0; i < scene().tables.size; i += 2) scene().points.home[i] = 1;
  SearchReaches reaches = for_every_region(SearchReach{SIZE_MAX, 20 * kUnitsPerMillimetre});
  reaches[0].points = 0;
  associate(scene().tables, scene().surface, scene().projector, scene().regions, reaches, scene().points);
  const std::size_t count = scene().points.correspondence_count;
  EXPECT_GT(count, 100U);
  for (const Correspondence& c : scene().points.correspondences.first(count)) ASSERT_EQ(c.region, 1);
}

TEST_F(Associate, FindsNothingInAnEmptyPictureOrOutside) {
  Picture nothing(scene().camera);
  scene().see(nothing);
  EXPECT_EQ(run(8191), 0U);
  scene().see_body(usual_pose());
  for (const Vector3& where :
       {Vector3(0, 0, -0.7), Vector3(5, 0, 0.7), Vector3(0, 0, 50), Vector3(0, 0, 0)}) {
    scene().place({usual_pose().rotation, where});
    EXPECT_EQ(run(8191), 0U);
  }
}

TEST(PlaneDistance, IsSignedAlongTheNormal) {
  const IntPoint point{100, -200, 16000}, towards{0, 0, -16384};
  EXPECT_EQ(plane_distance({100, -200, 15984}, point, towards), 256);  // 1 mm before
  EXPECT_EQ(plane_distance({500, 700, 16016}, point, towards), -256);  // 1 mm behind, wherever beside
  EXPECT_EQ(plane_distance({8291, 7991, 24191}, point, {9459, 9459, 9459}), 226'988);
}

TEST(FacesCamera, ComparesWithTheLineOfSight) {
  EXPECT_TRUE(faces_camera({0, 0, 16000}, {0, 0, -16384}, 4240));
  EXPECT_FALSE(faces_camera({0, 0, 16000}, {0, 0, 16384}, 4240));
  EXPECT_FALSE(faces_camera({0, 0, 16000}, {16384, 0, 0}, 0));
  EXPECT_TRUE(faces_camera({-16000, 0, 16000}, {16384, 0, 0}, 4240));  // seen from the side
}

TEST_F(Associate, PullsPartsButNotTheBaseBackFromWhereTheCameraSeesThrough) {
  RigidTransform off = usual_pose();
  off.translation.x() += 0.01;
  const auto sideways = [&](std::int8_t region) {
    scene().points.reset();
    scene().place(off);
    scene().regions[1] = scene().regions[0];
    std::fill(scene().points.home.begin(), scene().points.home.end(), region);
    std::pair<std::size_t, double> found{0, 0};  // rows along the picture, and their mean pull along x
    for (const Correspondence& c : scene().points.correspondences.first(run(20 * kUnitsPerMillimetre))) {
      const FixedPose pose(off, scene().tables.centre);
      const ModelTables& model = scene().tables;
      const IntPoint n = pose.direction(model.nx[c.index], model.ny[c.index], model.nz[c.index]);
      if (n.x == c.nx && n.y == c.ny && n.z == c.nz) continue;
      ++found.first;
      found.second += c.nx / 16384.0 * c.residual / 256.0;
    }
    return found;
  };
  EXPECT_EQ(sideways(0).first, 0U);
  const auto [count, pull] = sideways(1);
  ASSERT_GT(count, 20U);
  EXPECT_LT(pull / static_cast<double>(count), -2);  // millimetres, back to the left
}

}  // namespace
}  // namespace pliant

#include "core/track/placed_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/track/associate.hpp"
#include "core/track/contour.hpp"
#include "tests/core/synthetic.hpp"
#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::TrackScene;

TEST(PatchPoints, HoldEveryPointOnceWithItsPatch) {
  TrackScene scene(synthetic::bumpy_body());
  const ModelTables& model = scene.tables;
  const PatchPoints& points = model.by_patch;
  std::vector<int> seen(model.size, 0);
  for (std::size_t p = 0; p < scene.patches.count; ++p) {
    EXPECT_EQ(points.begin[p] % PatchPoints::kBlock, 0U);
    EXPECT_EQ(points.count[p], scene.patches.sizes[p]);
    for (std::size_t at = points.begin[p]; at < std::size_t{points.begin[p]} + points.count[p]; ++at) {
      const std::size_t i = points.index[at];
      ++seen[i];
      ASSERT_EQ(scene.patches.patch_of[i], p);
      ASSERT_EQ(points.x[at], model.x[i]);
      ASSERT_EQ(points.y[at], model.y[i]);
      ASSERT_EQ(points.z[at], model.z[i]);
      ASSERT_EQ(points.nx[at], model.nx[i]);
      ASSERT_EQ(points.ny[at], model.ny[i]);
      ASSERT_EQ(points.nz[at], model.nz[i]);
    }
  }
  for (const int times : seen) ASSERT_EQ(times, 1);
}

TEST(PlacedPoints, AreWhatThePoseSaysOfEachPoint) {
  TrackScene scene(synthetic::bumpy_body());
  const PatchPoints& points = scene.tables.by_patch;
  int sides[3] = {0, 0, 0};
  for (int turn = 0; turn < 12; ++turn) {
    // about every axis, half turns and a quarter's exact 1 in Q14 among them
    const Vector3 axis = turn % 3 == 0   ? Vector3(1, 0, 0)
                         : turn % 3 == 1 ? Vector3(0, 1, 0)
                                         : Vector3(1, 2, -1);
    // from near to beyond what is looked at, and as far aside
    const double away = turn < 9 ? 0.6 + 0.2 * turn : 9.5 * (turn - 8);
    const FixedPose pose(synthetic::pose_at({0.3 * away, -0.1 * away, away}, axis, turn * 0.5235987755982988),
                         scene.tables.centre);
    for (std::size_t p = 0; p < scene.patches.count; ++p) {
      const std::size_t count = std::min<std::size_t>(points.count[p], PlacedPoints::kMost);
      PlacedPoints placed;
      placed.place({points, points.begin[p]}, count, pose);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = points.begin[p] + k;
        const IntPoint point = pose.point(points.x[at], points.y[at], points.z[at]),
                       normal = pose.direction(points.nx[at], points.ny[at], points.nz[at]);
        ASSERT_EQ(placed.x[k], point.x);
        ASSERT_EQ(placed.y[k], point.y);
        ASSERT_EQ(placed.z[k], point.z);
        ASSERT_EQ(placed.nx[k], normal.x);
        ASSERT_EQ(placed.ny[k], normal.y);
        ASSERT_EQ(placed.nz[k], normal.z);
        const Side side = faces_camera(point, normal, kCos75) ? Side::facing
                          : on_rim(point, normal)             ? Side::rim
                                                              : Side::away;
        ASSERT_EQ(placed.side[k], side);
        ++sides[static_cast<int>(side)];
      }
    }
  }
  for (const int times : sides) EXPECT_GT(times, 100);
}

}  // namespace
}  // namespace pliant

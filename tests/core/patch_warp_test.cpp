#include "core/deform/patch_warp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::usual_pose;

class Warp : public synthetic::SharedScene<synthetic::bumpy_body> {
 protected:
  void SetUp() override {
    scene().points.reset();
    scene().place(usual_pose());
    scene().warp->reset(usual_pose());
  }

  /// A dent of 6 cm radius, `depth` metres deep, pressed away from the camera where the body bulges towards
  /// it.
  static Vector3 pressed(const Vector3& p, double depth) {
    const Vector3 away = usual_pose().rotation.transpose() * Vector3(0, 0, 1);
    const double square = (p - nearest()).squaredNorm() / (0.06 * 0.06);
    return square >= 1 ? p : Vector3(p + depth * (1 - square) * (1 - square) * away);
  }
  static const Vector3& nearest() {
    static const Vector3 found = search_nearest();
    return found;
  }
  static Vector3 search_nearest() {
    std::size_t best = 0;
    for (std::size_t i = 0; i < scene().tables.size; ++i)
      if ((usual_pose() * scene().rest(i)).z() < (usual_pose() * scene().rest(best)).z()) best = i;
    return scene().rest(best);
  }
  static void see(double depth, double noise = 0) {
    Picture picture(scene().camera);
    picture.draw(scene().mesh, usual_pose(), [depth](const Vector3& p) { return pressed(p, depth); });
    picture.wall(1.6);
    if (noise > 0) picture.shake(noise, 5);
    scene().see(picture);
  }
  /// Sorted errors against the pressed shape, metres: of points that face the camera and are `moved` by more
  /// than 6 mm or not.
  static std::vector<double> errors(double depth, bool moved) {
    const WarpLanes lanes = lanes_of(scene().patches, *scene().warp);
    std::vector<double> out;
    for (std::size_t i = 0; i < scene().tables.size; ++i) {
      const Vector3 rest = scene().rest(i);
      const Vector3 truth = usual_pose() * pressed(rest, depth);
      if (((pressed(rest, depth) - rest).norm() > 0.006) != moved) continue;
      if (scene().normal(usual_pose(), i).dot(truth) > -0.5 * truth.norm()) continue;
      out.push_back(scene().off(lanes, i, truth));
    }
    std::sort(out.begin(), out.end());
    return out;
  }
};

TEST_F(Warp, StaysWithTheRegionWhereNothingDeforms) {
  for (const double noise : {0.0, 0.001}) {
    see(0, noise);
    for (int frame = 0; frame < 10; ++frame) scene().warp_now();
    const std::vector<double> still = errors(0, false);
    ASSERT_GT(still.size(), 500U);
    EXPECT_LT(still[still.size() / 2], 0.001) << noise;
    EXPECT_LT(still[still.size() * 99 / 100], 0.005) << noise;
  }
}

TEST_F(Warp, FollowsAPressAndComesBack) {
  constexpr double kDeepest = 0.02;
  for (int step = 0; step <= 12; ++step) {
    see(kDeepest * step / 12);
    scene().warp_now();
  }
  const std::vector<double> moved = errors(kDeepest, true), still = errors(kDeepest, false);
  ASSERT_GT(moved.size(), 60U);
  EXPECT_LT(moved[moved.size() / 2], 0.003);
  EXPECT_LT(moved[moved.size() * 9 / 10], 0.008);
  EXPECT_LT(still[still.size() / 2], 0.001);
  for (int step = 12; step >= 0; --step) {
    see(kDeepest * step / 12);
    scene().warp_now();
  }
  see(0);
  for (int frame = 0; frame < 5; ++frame) scene().warp_now();
  const std::vector<double> back = errors(0, false);
  EXPECT_LT(back[back.size() / 2], 0.001);
  EXPECT_LT(back[back.size() * 95 / 100], 0.003);
}

TEST_F(Warp, IsNotPulledOutOfAShadow) {
  Picture picture(scene().camera);
  picture.draw(scene().mesh, usual_pose());
  picture.wall(1.6);
  picture.block(165, 60, 195, 180, 0.45);
  picture.block(151, 60, 165, 180, 0);  // where the sensor's projector does not get past it
  picture.shake(0.001, 5);
  scene().see(picture);
  for (int frame = 0; frame < 20; ++frame) scene().warp_now();
  const std::vector<double> still = errors(0, false);
  ASSERT_GT(still.size(), 500U);
  EXPECT_LT(still[still.size() * 99 / 100], 0.002);
}

TEST_F(Warp, IsNotPulledByWhatStandsInFront) {
  Picture picture(scene().camera);
  picture.draw(scene().mesh, usual_pose());
  picture.wall(1.6);
  picture.block(130, 60, 190, 240, 0.62);  // an arm, centimetres before the object
  scene().see(picture);
  for (int frame = 0; frame < 10; ++frame) scene().warp_now();
  const std::vector<double> still = errors(0, false);
  EXPECT_LT(still[still.size() / 2], 0.001);
  EXPECT_LT(still[still.size() * 95 / 100], 0.003);
}

TEST_F(Warp, KeepsTheShapeWithoutReadings) {
  Picture nothing(scene().camera);
  scene().see(nothing);
  for (int frame = 0; frame < 10; ++frame) scene().warp_now();
  EXPECT_LT(errors(0, false).back(), 0.0005);
  for (std::size_t p = 0; p < scene().patches.count; ++p) EXPECT_EQ(scene().warp->seen[p], 0);
}

TEST_F(Warp, WhatIsFarOutOfBalanceDragsNothingAlong) {
  // Patches that nobody sees, as a part that was lost behind the body leaves them.
  see(0);
  scene().warp_now();
  std::vector<std::size_t> flung;
  for (std::size_t p = 0; p < scene().patches.count; ++p)
    if (scene().warp->seen[p] == 0 && flung.size() < 5) flung.push_back(p);
  ASSERT_EQ(flung.size(), 5U);
  const auto place = [](std::size_t p) { return usual_pose() * scene().patches.centres[p]; };
  const auto now = [](std::size_t p) { return scene().warp->pose[p] * scene().patches.centres[p]; };
  for (const std::size_t p : flung) {
    const Matrix3 turned = synthetic::turn({1, 1, 0}, 1.8) * usual_pose().rotation;
    scene().warp->pose[p] = {turned,
                             place(p) + Vector3(0.1, -0.12, 0.1) - turned * scene().patches.centres[p]};
  }
  for (int frame = 0; frame < 30; ++frame) {
    scene().warp_now();
    const std::vector<double> seen = errors(0, false);
    ASSERT_LT(seen[seen.size() * 95 / 100], 0.005) << frame;
  }
  for (const std::size_t p : flung) EXPECT_LT((now(p) - place(p)).norm(), 0.01) << p;
}

TEST_F(Warp, MovesAlongWithItsRegion) {
  see(0);
  scene().warp_now();
  scene().regions[0].last_pose = usual_pose();
  scene().regions[0].pose.translation += Vector3(0.3, 0.1, 0.2);  // nothing is seen there
  Picture nothing(scene().camera);
  scene().see(nothing);
  scene().warp_now();
  const IntPoint p =
      warped_point(scene().tables, scene().patches, lanes_of(scene().patches, *scene().warp), 100);
  const Vector3 expected = scene().regions[0].pose * scene().rest(100);
  EXPECT_LT((Vector3(p.x, p.y, p.z) / kUnitsPerMetre - expected).norm(), 0.005);
}

TEST_F(Warp, StifferMaterialFollowsAPressLess) {
  std::vector<double> median;
  for (const double material : {0.0, 1.0}) {
    SetUp();
    see(0.02);
    WarpSettings settings = scene().warp_settings();
    settings.material = material;
    for (int frame = 0; frame < 3; ++frame) scene().warp_now(settings);
    const std::vector<double> moved = errors(0.02, true);
    median.push_back(moved[moved.size() / 2]);
  }
  EXPECT_LT(median[1], median[0]);
}

}  // namespace
}  // namespace pliant

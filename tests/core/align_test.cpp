#include "core/track/align.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::degrees_between;
using synthetic::Picture;
using synthetic::pose_at;
using synthetic::TrackScene;
using synthetic::usual_pose;

class Align : public synthetic::SharedScene<synthetic::bumpy_body> {
 protected:
  void SetUp() override { scene().points.reset(); }

  static RigidTransform moved(const RigidTransform& pose, double metres, double radians, unsigned which) {
    const Vector3 axis(which % 3 == 0 ? 1 : 0.3, which % 3 == 1 ? 1 : -0.2, which % 3 == 2 ? 1 : 0.1);
    return {synthetic::turn(axis, radians) * pose.rotation, pose.translation + metres * axis.normalized()};
  }
  /// How far off the truth: at the centre, millimetres.
  static double millimetres(const RigidTransform& pose) {
    const Vector3 centre = scene().tables.centre;
    return (pose * centre - usual_pose() * centre).norm() * 1000;
  }
};

TEST_F(Align, FindsTheTruePoseFromAFramesMotionAway) {
  scene().see_body(usual_pose());
  for (unsigned which = 0; which < 6; ++which) {
    scene().place(moved(usual_pose(), which < 3 ? 0.012 : -0.012, which % 2 == 0 ? 0.07 : -0.07, which));
    scene().align_rounds(10, 40);
    EXPECT_LT(degrees_between(scene().regions[0].pose.rotation, usual_pose().rotation), 0.25) << which;
    EXPECT_LT(millimetres(scene().regions[0].pose), 0.5) << which;
    EXPECT_LT(scene().regions[0].rms, 0.001);
  }
}

TEST_F(Align, FindsItUnderNoise) {
  scene().see_body(usual_pose(), 0.0015);
  scene().place(moved(usual_pose(), 0.01, 0.05, 1));
  scene().align_rounds(10, 40);
  EXPECT_LT(degrees_between(scene().regions[0].pose.rotation, usual_pose().rotation), 0.4);
  EXPECT_LT(millimetres(scene().regions[0].pose), 0.8);
}

TEST_F(Align, IsNotDraggedByADent) {
  const RigidTransform pose = usual_pose();
  Picture picture(scene().camera);
  // a fifth of the surface stands out by up to 15 mm
  picture.draw(scene().mesh, pose,
               [](const Vector3& p) { return Vector3(p * (1 + std::clamp(4 * (p.x() - 0.07), 0.0, 0.13))); });
  picture.wall(1.6);
  scene().see(picture);
  scene().place(moved(pose, 0.004, 0.02, 2));
  scene().align_rounds(12, 24);
  EXPECT_LT(degrees_between(scene().regions[0].pose.rotation, pose.rotation), 1.0);
  EXPECT_LT(millimetres(scene().regions[0].pose), 2.0);
  // Equal weights are.
  const double robust = millimetres(scene().regions[0].pose);
  scene().place(moved(pose, 0.004, 0.02, 2));
  scene().align_rounds(12, 24, false);
  EXPECT_GT(millimetres(scene().regions[0].pose), robust);
}

TEST_F(Align, IsNotDraggedByAnOccluder) {
  const RigidTransform pose = usual_pose();
  Picture picture(scene().camera);
  picture.draw(scene().mesh, pose);
  picture.wall(1.6);
  picture.block(150, 110, 175, 240, 0.58);  // an arm, 10 cm before the object
  scene().see(picture);
  scene().place(moved(pose, 0.004, 0.02, 2));
  scene().align_rounds(12, 24);
  EXPECT_LT(degrees_between(scene().regions[0].pose.rotation, pose.rotation), 0.5);
  EXPECT_LT(millimetres(scene().regions[0].pose), 1.0);
}

TEST_F(Align, LeavesARegionWithTooFewReadingsAlone) {
  scene().see_body(usual_pose());
  const RigidTransform off = moved(usual_pose(), 0.01, 0.05, 0);
  scene().place(off);
  // fewer than kFewestCorrespondences of 40 points face the camera
  associate(scene().tables, scene().surface, scene().projector, scene().regions,
            for_every_region(SearchReach{40, 40 * kUnitsPerMillimetre}), scene().points);
  ASSERT_LT(scene().points.correspondence_count, kFewestCorrespondences);
  EXPECT_LT(align(scene().surface, {}, {}, scene().points, scene().regions)[0], 0);
  EXPECT_EQ((scene().regions[0].pose.rotation - off.rotation).norm(), 0.0);
  EXPECT_EQ((scene().regions[0].pose.translation - off.translation).norm(), 0.0);
}

TEST_F(Align, KeepsToThePredictionWhereTheSurfaceSaysNothing) {
  // A plane fixes neither its own turning nor its sliding.
  Geometry plane;
  constexpr int kSide = 40;
  for (int r = 0; r <= kSide; ++r)
    for (int c = 0; c <= kSide; ++c)
      plane.vertices.push_back(
          {0.2F * static_cast<float>(c) / kSide - 0.1F, 0.2F * static_cast<float>(r) / kSide - 0.1F, 0});
  for (int r = 0; r < kSide; ++r)
    for (int c = 0; c < kSide; ++c) {
      const auto a = static_cast<std::uint32_t>(r * (kSide + 1) + c);
      plane.triangles.push_back({a, a + kSide + 2, a + 1});
      plane.triangles.push_back({a, a + kSide + 1, a + kSide + 2});
    }
  TrackScene flat(plane);
  const RigidTransform pose = pose_at({0, 0, 0.7});
  Picture picture(flat.camera);
  picture.wall(0.705);  // 5 mm behind
  flat.see(picture);
  flat.place(pose);
  flat.align_rounds(6, 20);
  const RigidTransform& found = flat.regions[0].pose;
  EXPECT_NEAR(found.translation.z(), 0.705, 0.0006);
  EXPECT_NEAR(found.translation.x(), 0, 0.001);
  EXPECT_NEAR(found.translation.y(), 0, 0.001);
  EXPECT_LT(degrees_between(found.rotation, pose.rotation), 0.5);
}

}  // namespace
}  // namespace pliant

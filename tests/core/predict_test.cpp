#include "core/track/predict.hpp"

#include <gtest/gtest.h>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::degrees_between;
using synthetic::Picture;
using synthetic::pose_at;
using synthetic::TrackScene;
using synthetic::usual_pose;

TEST(Predict, GoesOnWithMostOfTheMotion) {
  RegionSet regions;
  regions[0].alive = true;
  regions[0].pose = usual_pose();
  regions[0].motion = {synthetic::turn({0, 0, 1}, 0.1), Vector3::Zero()};
  // a translation of the object's origin by 10 mm
  regions[0].motion.translation =
      usual_pose().translation + Vector3(0.01, 0, 0) - regions[0].motion.rotation * usual_pose().translation;
  predict(regions);
  EXPECT_NEAR((regions[0].pose.translation - usual_pose().translation).norm(), 0.01 * kMotionKept, 1e-9);
  EXPECT_NEAR(degrees_between(regions[0].pose.rotation, usual_pose().rotation), 0.1 * kMotionKept * 57.2958,
              0.01);
  EXPECT_EQ((regions[0].predicted.translation - regions[0].pose.translation).norm(), 0.0);
  EXPECT_EQ((regions[0].last_pose.translation - usual_pose().translation).norm(), 0.0);
}

TEST(Predict, CarriesAnUnseenRegionWithItsParent) {
  RegionSet regions;
  regions[0].alive = regions[1].alive = true;
  regions[0].pose = usual_pose();
  regions[1].parent = 0;
  regions[1].from_parent = pose_at({0.02, 0, 0}, {0, 0, 1}, 0.3);
  regions[1].pose = regions[0].pose * regions[1].from_parent;
  regions[1].frames_unseen = 2;
  regions[0].motion.translation = Vector3(0, 0.02, 0);
  predict(regions);
  const RigidTransform expected = regions[0].pose * regions[1].from_parent;
  EXPECT_LT((regions[1].pose.translation - expected.translation).norm(), 1e-12);
  EXPECT_LT((regions[1].pose.rotation - expected.rotation).norm(), 1e-12);
}

TEST(Predict, LeavesDeadRegionsAlone) {
  RegionSet regions;
  predict(regions);
  for (const TrackedRegion& region : regions) {
    EXPECT_FALSE(region.alive);
    EXPECT_EQ((region.pose.translation).norm(), 0.0);
  }
}

TEST(PredictedWindow, HoldsTheObjectWithRoomAndStaysInThePicture) {
  TrackScene scene(synthetic::bumpy_body());
  for (const Vector3& where :
       {Vector3(0, 0, 0.8), Vector3(0.3, 0.2, 0.8), Vector3(0, 0, 0.3), Vector3(0, 0, 3)}) {
    const RigidTransform pose = pose_at(where, {1, 1, 0}, 1.0);
    scene.place(pose);
    const Window w = predicted_window(scene.tables, scene.projector, scene.points, scene.regions,
                                      20 * kUnitsPerMillimetre, scene.camera.width, scene.camera.height);
    ASSERT_FALSE(w.empty());
    EXPECT_GE(w.u0, 0);
    EXPECT_GE(w.v0, 0);
    EXPECT_LE(w.u1, scene.camera.width);
    EXPECT_LE(w.v1, scene.camera.height);
    Picture picture(scene.camera);
    picture.draw(scene.mesh, pose);
    for (int v = 0; v < scene.camera.height; ++v)
      for (int u = 0; u < scene.camera.width; ++u)
        if (picture.depth(u, v) > 0) {
          ASSERT_TRUE(w.contains(u, v)) << u << " " << v;
        }
  }
  scene.place(pose_at({0, 0, -1}));
  EXPECT_TRUE(
      predicted_window(scene.tables, scene.projector, scene.points, scene.regions, 320, 320, 240).empty());
}

TEST(ChooseStillOrMoving, BelievesThePicture) {
  TrackScene scene(synthetic::bumpy_body());
  const RigidTransform before = usual_pose();
  RigidTransform after = before;
  after.translation += Vector3(0.015, 0, 0.01);
  for (const bool moves : {false, true}) {
    scene.see_body(before);
    scene.place(before);
    (void)scene.label_now();  // the last frame: what agreed there has a say
    scene.see_body(moves ? after : before);
    scene.place(before);
    scene.regions[0].pose = scene.regions[0].predicted = after;
    choose_still_or_moving(scene.tables, scene.surface, scene.projector, scene.points, 512, scene.regions);
    EXPECT_EQ((scene.regions[0].pose.translation - (moves ? after : before).translation).norm(), 0.0)
        << moves;
  }
}

}  // namespace
}  // namespace pliant

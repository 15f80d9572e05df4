#include "core/track/joints.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/deform/strain.hpp"
#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::pose_at;
using synthetic::TrackScene;
using synthetic::usual_pose;

class FindJoints : public synthetic::SharedScene<synthetic::two_part_bar> {
 protected:
  void SetUp() override {
    scene().place(usual_pose());
    scene().warp->pose.fill(usual_pose());
    scene().warp->home.fill(0);
  }
  static void add_region(std::size_t id, std::int8_t parent) {
    TrackedRegion& region = scene().regions[id];
    region.alive = true;
    region.parent = parent;
    region.pose = region.last_pose = usual_pose();
  }
  /// Patches from `x` on, metres along the bar, belong to `region`.
  static void give_from(double x, std::int8_t region) {
    for (std::size_t p = 0; p < scene().patches.count; ++p)
      if (scene().patches.centres[p].x() >= x) scene().warp->home[p] = region;
  }
  static Joints joints() { return find_joints(scene().patches, *scene().warp, scene().regions); }
  static Vector3 middle(std::int8_t a, std::int8_t b) {
    Vector3 joint;
    EXPECT_TRUE(find_joint(scene().patches, *scene().warp, a, b, joint));
    return joint;
  }
};

TEST_F(FindJoints, TiesAPartToItsParentAndTheBaseToNothing) {
  add_region(1, 0);
  give_from(0, 1);
  const Joints found = joints();
  EXPECT_FALSE(found[0].tied);
  ASSERT_TRUE(found[1].tied);
  EXPECT_LT((found[1].place - middle(1, 0)).norm(), 1e-12);
  EXPECT_LT((found[1].target - usual_pose() * middle(1, 0)).norm(), 1e-12) << "where it is already";
  EXPECT_GT(found[1].give, 0);
  EXPECT_LT(found[1].give, scene().patches.radius);
  for (std::size_t k = 2; k < found.size(); ++k) EXPECT_FALSE(found[k].tied) << k;
}

TEST_F(FindJoints, FollowsTheParentsStep) {
  add_region(1, 0);
  give_from(0, 1);
  const RigidTransform step = pose_at({0.02, -0.01, 0.005}, {0, 1, 1}, 0.1);
  scene().regions[0].pose = step * usual_pose();
  scene().regions[1].pose = pose_at({0.1, 0.1, 0.1}, {1, 0, 0}, 0.3) * usual_pose();  // of no account
  const Joints found = joints();
  EXPECT_LT((found[1].target - step * (usual_pose() * found[1].place)).norm(), 1e-12);
}

TEST_F(FindJoints, TiesToTheParentBeforeOthers) {
  // The middle part touches both ends and hangs on the left one.
  add_region(1, 0);
  add_region(2, 1);
  give_from(-0.06, 1);
  give_from(0.06, 2);
  Joints found = joints();
  ASSERT_TRUE(found[1].tied);
  EXPECT_LT((found[1].place - middle(1, 0)).norm(), 1e-12);
  ASSERT_TRUE(found[2].tied);
  EXPECT_LT((found[2].place - middle(2, 1)).norm(), 1e-12);

  // The end hangs on the base, which it does not touch: what it touches holds it.
  scene().regions[2].parent = 0;
  const RigidTransform step = pose_at({0.01, 0, 0});
  scene().regions[1].pose = step * usual_pose();
  found = joints();
  ASSERT_TRUE(found[2].tied);
  EXPECT_LT((found[2].place - middle(2, 1)).norm(), 1e-12);
  EXPECT_LT((found[2].target - step * (usual_pose() * found[2].place)).norm(), 1e-12);
}

TEST_F(FindJoints, APartThatTouchesNothingAliveIsFree) {
  add_region(1, 0);
  EXPECT_FALSE(joints()[1].tied) << "it has no patch";
  add_region(2, 0);
  give_from(-0.06, 1);
  give_from(0.06, 2);
  scene().regions[1].alive = false;
  const Joints found = joints();
  EXPECT_FALSE(found[1].tied);
  EXPECT_FALSE(found[2].tied);
}

/// A smooth round rod along x, longer than the picture is wide: nothing seen of it tells how it slides.
Geometry endless_rod() {
  constexpr int kAround = 48, kAlong = 140;
  constexpr double kRadius = 0.04, kLength = 1.4;
  Geometry rod;
  for (int r = 0; r <= kAlong; ++r)
    for (int c = 0; c < kAround; ++c) {
      const double angle = 2 * std::numbers::pi * c / kAround;
      rod.vertices.push_back({static_cast<float>(kLength * (static_cast<double>(r) / kAlong - 0.5)),
                              static_cast<float>(kRadius * std::cos(angle)),
                              static_cast<float>(kRadius * std::sin(angle))});
    }
  for (int r = 0; r < kAlong; ++r)
    for (int c = 0; c < kAround; ++c) {
      const auto a = static_cast<std::uint32_t>(r * kAround + c);
      const auto b = static_cast<std::uint32_t>(r * kAround + (c + 1) % kAround);
      rod.triangles.push_back({a, b, b + kAround});
      rod.triangles.push_back({a, b + kAround, a + kAround});
    }
  return rod;
}

/// Aligns the rod's right half, which starts at `start`, for some frames, each of which predicts that it goes
/// on by `step`; where it comes. The rod stands still at `truth`.
RigidTransform follow(TrackScene& scene, const RigidTransform& truth, const RigidTransform& start,
                      const RigidTransform& step, int frames, bool tied) {
  scene.place(truth);
  scene.warp->pose.fill(truth);
  for (std::size_t p = 0; p < scene.patches.count; ++p)
    scene.warp->home[p] = scene.patches.centres[p].x() < 0 ? 0 : 1;
  for (std::size_t i = 0; i < scene.tables.size; ++i)
    scene.points.home[i] = scene.warp->home[scene.patches.patch_of[i]];
  TrackedRegion& part = scene.regions[1];
  part.alive = true;
  part.parent = 0;
  part.pose = start;
  for (int frame = 0; frame < frames; ++frame) {
    scene.regions[0].pose = truth;
    part.last_pose = part.pose;
    part.pose = part.predicted = part.pose * step;
    for (int round = 0; round < 4; ++round) {
      constexpr std::int32_t kGate = 20 * kUnitsPerMillimetre;
      associate(scene.tables, scene.surface, scene.projector, scene.regions,
                for_every_region(SearchReach{scene.tables.size, kGate}), scene.points);
      AlignSettings align_settings;
      align_settings.widest = for_every_region(kGate);
      const Joints joints = find_joints(scene.patches, *scene.warp, scene.regions);
      (void)align(scene.surface, align_settings, tied ? joints : Joints{}, scene.points, scene.regions);
    }
  }
  return part.pose;
}

class AlignAtAJoint : public ::testing::Test {
 protected:
  AlignAtAJoint() : scene_(endless_rod(), 0.012), truth_(pose_at({0, 0, 0.75})) {
    scene_.see_body(truth_, 0.001);
  }
  TrackScene scene_;
  RigidTransform truth_;
};

TEST_F(AlignAtAJoint, HoldsWhatSlidesAlongItself) {
  const auto slid = [&](bool tied) {
    const RigidTransform pose = follow(scene_, truth_, truth_, pose_at({0.002, 0, 0}), 15, tied);
    return std::fabs((pose.translation - truth_.translation).dot(truth_.rotation * Vector3(1, 0, 0)));
  };
  const double tied = slid(true), free = slid(false);
  const double give = find_joints(scene_.patches, *scene_.warp, scene_.regions)[1].give;
  ASSERT_GT(give, 0);
  EXPECT_LT(tied, give);
  EXPECT_GT(free, 2 * give) << "the surface alone does not hold it";
}

TEST_F(AlignAtAJoint, WhatTurnsAboutItselfUnseenTurnsBackToItsParent) {
  const RigidTransform start = truth_ * pose_at(Vector3::Zero(), {1, 0, 0}, 0.3);
  const auto turned = [&](bool tied) {
    const RigidTransform pose = follow(scene_, truth_, start, RigidTransform(), 60, tied);
    return synthetic::degrees_between(pose.rotation, truth_.rotation);
  };
  EXPECT_GT(turned(false), 13);  // of 17
  EXPECT_LT(turned(true), 8.6);
}

}  // namespace
}  // namespace pliant

#include "core/track/regain_hold.hpp"

#include <gtest/gtest.h>

#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::pose_at;
using synthetic::usual_pose;

class RegainHold : public synthetic::SharedScene<synthetic::two_part_bar> {
 protected:
  void SetUp() override {
    scene().points.reset();
    scene().place(usual_pose());
    scene().warp->reset(usual_pose());
    scene().warp->home.fill(0);
    for (std::size_t p = 0; p < scene().patches.count; ++p) scene().warp->seen[p] = scene().patches.sizes[p];
    for (std::uint8_t& evidence : scene().points.evidence) evidence = kEvidenceMax;
  }
  static void move_from(double x, const RigidTransform& motion) {
    for (std::size_t p = 0; p < scene().patches.count; ++p)
      if (scene().patches.centres[p].x() >= x) scene().warp->pose[p] = motion * scene().warp->pose[p];
  }
  static void regain() {
    regain_hold(scene().tables, scene().patches, *scene().warp, scene().tolerance, scene().regions[0],
                scene().points);
  }
  static double moved() { return (scene().regions[0].pose.translation - usual_pose().translation).norm(); }
  static std::size_t void_evidence() {
    std::size_t count = 0;
    for (const std::uint8_t evidence : scene().points.evidence) count += evidence == 0 ? 1U : 0U;
    return count;
  }
};

TEST_F(RegainHold, GoesWhereAllOfTheObjectWent) {
  const RigidTransform motion = pose_at({0.02, 0.005, 0.01}, {0, 1, 0}, 0.05);
  move_from(-1, motion);
  regain();
  const RigidTransform truth = motion * usual_pose();
  EXPECT_LT((scene().regions[0].pose.translation - truth.translation).norm(), 1e-4);
  EXPECT_LT(synthetic::degrees_between(scene().regions[0].pose.rotation, truth.rotation), 0.02);
  EXPECT_EQ(void_evidence(), scene().tables.size) << "nothing is off the base any more";
}

TEST_F(RegainHold, GoesWhereTheLargerPartWentAndLeavesTheRestDeformed) {
  move_from(-0.06, pose_at({0, 0.02, 0}));
  regain();
  EXPECT_NEAR(moved(), 0.02, 0.003);
  EXPECT_GT(void_evidence(), scene().tables.size / 2);
  EXPECT_LT(void_evidence(), scene().tables.size * 9 / 10);
}

TEST_F(RegainHold, StaysWhereMostOfItStands) {
  move_from(0.04, pose_at({0, 0.02, 0}));
  regain();
  EXPECT_EQ(moved(), 0.0);
  EXPECT_EQ(void_evidence(), 0U);
}

TEST_F(RegainHold, StaysWhereNoMotionIsShared) {
  for (std::size_t p = 0; p < scene().patches.count; ++p)
    scene().warp->pose[p].translation += Vector3(0.03 * static_cast<double>(p + 1), 0, 0);
  regain();
  EXPECT_EQ(moved(), 0.0);
  EXPECT_EQ(void_evidence(), 0U);
}

TEST_F(RegainHold, StaysWhereNothingIsSeen) {
  move_from(-1, pose_at({0, 0.02, 0}));
  scene().warp->seen.fill(0);
  regain();
  EXPECT_EQ(moved(), 0.0);
}

}  // namespace
}  // namespace pliant

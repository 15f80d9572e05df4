#include "core/track/label.hpp"

#include <gtest/gtest.h>

#include <map>

#include "core/track/model_error.hpp"
#include "core/track/sight.hpp"
#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::usual_pose;

class Label : public synthetic::SharedScene<synthetic::bumpy_body> {
 protected:
  void SetUp() override {
    scene().points.reset();
    scene().place(usual_pose());
  }
  std::map<int, std::size_t> labels() {
    std::map<int, std::size_t> count;
    for (const std::int8_t l : scene().points.label) ++count[l];
    return count;
  }
  static double limit() {
    return scene().tolerance.deformed(depth_of(usual_pose(), scene().tables.centre)) / kUnitsPerMetre;
  }
  /// The warp alone has all of the body at `pose`; its region does not.
  static void warp_to(const RigidTransform& pose) {
    scene().warp->home.fill(0);
    scene().warp->rigid.fill(false);
    scene().warp_to(pose);
  }
  SightCounts frames(int count, bool with_memory = true) {
    SightCounts counts;
    for (int i = 0; i < count; ++i) counts = scene().label_now(with_memory);
    return counts;
  }
};

TEST_F(Label, AllThatIsSeenAgreesAtTheTruePose) {
  scene().see_body(usual_pose());
  const SightCounts counts = frames(3);
  EXPECT_GT(counts.facing, scene().tables.size / 4);
  EXPECT_LT(counts.in_front + counts.behind, counts.facing / 12);
  const auto count = labels();
  EXPECT_EQ(count.count(kDeformed) != 0 ? count.at(kDeformed) : 0, 0U);
  EXPECT_GT(count.at(0), counts.facing * 9 / 10);
  for (std::size_t i = 0; i < scene().tables.size; ++i) {
    if (scene().points.label[i] < 0) {
      ASSERT_EQ(scene().points.match[i], -1);
      continue;
    }
    const int u = scene().points.match[i] % scene().camera.width,
              v = scene().points.match[i] / scene().camera.width;
    const std::uint16_t z8 = scene().surface.depth(u, v);
    ASSERT_GT(z8, 0);
    const IntPoint q = scene().surface.vertex(u, v, z8), p = scene().points.position[i];
    ASSERT_LT(std::abs(q.x - p.x) + std::abs(q.y - p.y), 30 * kUnitsPerMillimetre);
  }
}

TEST_F(Label, PointsStandWhereTheSurfaceIsFoundOffTheModel) {
  constexpr double kPadding = 0.003;  // metres
  ASSERT_LT(kPadding, limit());
  for (const double padding : {0.0, kPadding}) {
    SetUp();
    Picture picture(scene().camera);
    picture.draw(scene().mesh, usual_pose(),
                 [&](const Vector3& p) { return Vector3(p + padding * p.normalized()); });
    picture.wall(1.6);
    scene().see(picture);
    frames(6);
    std::size_t rigid = 0, in_place = 0;
    for (std::size_t i = 0; i < scene().tables.size; ++i) {
      if (scene().points.label[i] != 0) continue;
      const Vector3 normal = scene().normal(usual_pose(), i);
      if (normal.z() > -0.7) continue;  // square to the line of sight, where readings tell the most
      const IntPoint& p = scene().points.position[i];
      const Vector3 from_region = Vector3(p.x, p.y, p.z) / kUnitsPerMetre - usual_pose() * scene().rest(i);
      const double outwards = padding * normal.dot(usual_pose().rotation * scene().rest(i).normalized());
      ++rigid;
      in_place += (from_region - outwards * normal).norm() < 0.0007 ? 1U : 0U;
    }
    EXPECT_GT(rigid, 300U);
    EXPECT_GT(in_place, rigid * 9 / 10) << padding;
  }
}

TEST(ModelError, IsNothingWithinTheNoiseAndAllOfWhatIsTwiceThat) {
  constexpr std::int32_t kNoise = 10, kLimit = 64;  // 1/16 mm
  EXPECT_EQ(model_error(kNoise * 16, kNoise, kLimit), 0);
  EXPECT_EQ(model_error(-kNoise * 16, kNoise, kLimit), 0);
  EXPECT_EQ(model_error(kNoise * 24, kNoise, kLimit), kNoise);
  EXPECT_EQ(model_error(kNoise * 40, kNoise, kLimit), 25);
  EXPECT_EQ(model_error(kNoise * 400, kNoise, kLimit), kLimit);
  for (std::int32_t misfit = -2000; misfit < 2000; ++misfit) {
    const std::int32_t error = model_error(misfit, kNoise, kLimit);
    EXPECT_EQ(error, -model_error(-misfit, kNoise, kLimit)) << misfit;
    const std::int32_t step = model_error(misfit + 1, kNoise, kLimit) - error;
    EXPECT_TRUE(step == 0 || step == 1) << misfit;
  }
}

TEST_F(Label, WhatStandsBehindSomethingElseIsNotObserved) {
  Picture picture(scene().camera);
  picture.draw(scene().mesh, usual_pose());
  picture.wall(1.6);
  picture.block(0, 0, 160, 240, 0.4);  // a board before the left half
  scene().see(picture);
  const SightCounts counts = frames(6);
  EXPECT_GT(counts.behind, counts.facing / 8);
  EXPECT_LT(counts.deformed, counts.behind / 8);
  for (std::size_t i = 0; i < scene().tables.size; ++i) {
    int u = 0, v = 0;
    if (!scene().projector.project(scene().points.position[i], u, v) || u > 156) continue;
    ASSERT_EQ(scene().points.label[i], kNotObserved) << i;
  }
  EXPECT_GT(labels().at(0), counts.facing / 4);
}

TEST_F(Label, WhatTheCameraSeesThroughIsDeformedAfterClearEvidence) {
  Picture picture(scene().camera);
  // the half beyond x = 3 cm caves in by up to 4 cm
  picture.draw(scene().mesh, usual_pose(), [](const Vector3& p) {
    return Vector3(p * (1 - 0.35 * std::clamp((p.x() - 0.03) * 50, 0.0, 1.0)));
  });
  picture.wall(1.6);
  scene().see(picture);
  const SightCounts first = frames(1);
  EXPECT_GT(first.in_front, first.facing / 12);
  EXPECT_EQ(labels().count(kDeformed), 0U);  // one frame is no evidence
  frames(1, false);
  EXPECT_GT(labels().at(kDeformed), first.in_front / 2) << "without memory it is";
  scene().points.reset();
  frames(4);
  const auto count = labels();
  ASSERT_EQ(count.count(kDeformed), 1U);
  EXPECT_GT(count.at(kDeformed), first.in_front / 2);
  for (std::size_t i = 0; i < scene().tables.size; ++i)
    if (scene().points.label[i] == kDeformed) {
      ASSERT_GT(scene().rest(i).x(), 0.015) << i;
    }
  // and back again
  scene().see_body(usual_pose());
  frames(8);
  EXPECT_EQ(labels().count(kDeformed), 0U);
}

TEST_F(Label, WhatTheWarpTakesThreeQuartersOfTheLimitAwayIsDeformed) {
  for (const double share : {0.6, 0.9}) {
    SetUp();
    RigidTransform seen = usual_pose();
    seen.translation.z() += share * limit();
    scene().see_body(seen);
    warp_to(seen);
    SightCounts counts;
    for (int frame = 0; frame < 8; ++frame) counts = scene().look_now();
    const auto count = labels();
    const std::size_t deformed = count.count(kDeformed) != 0 ? count.at(kDeformed) : 0;
    if (share < 0.75) {
      EXPECT_LT(deformed, counts.facing / 20);
    } else {
      EXPECT_GT(deformed, counts.facing * 3 / 4);
    }
  }
}

TEST_F(Label, WhatLeftItsRegionIsMatchedBesideAHole) {
  RigidTransform seen = usual_pose();
  seen.translation.z() += 0.9 * limit();
  Picture picture(scene().camera);
  picture.draw(scene().mesh, seen);
  picture.wall(1.6);
  constexpr int kLeft = 157, kRight = 163;
  picture.block(kLeft, 0, kRight, 240, 0);  // no readings there
  scene().see(picture);
  warp_to(seen);
  for (int frame = 0; frame < 8; ++frame) (void)scene().look_now();
  const FixedPose fixed(seen, scene().tables.centre);
  const ModelTables& model = scene().tables;
  std::size_t inside = 0, matched = 0;
  for (std::size_t i = 0; i < model.size; ++i) {
    const IntPoint p = fixed.point(model.x[i], model.y[i], model.z[i]);
    int u = 0, v = 0;
    if (!faces_camera(p, fixed.direction(model.nx[i], model.ny[i], model.nz[i]), 8192) ||
        !scene().projector.project(p, u, v) || u < kLeft + 1 || u > kRight - 2)
      continue;
    ++inside;
    if (scene().points.label[i] != kDeformed) continue;
    ++matched;
    const int beside = scene().points.match[i] % scene().camera.width;
    EXPECT_TRUE(beside < kLeft || beside >= kRight) << beside;
  }
  EXPECT_GE(inside, 8U);
  EXPECT_GE(matched * 4, inside * 3);
}

TEST_F(Label, WhatOnlyTurnedIntoSightIsNotDeformed) {
  // the warp has the body turned a little about itself, as it is seen; its region does not
  const Vector3 at = usual_pose() * scene().tables.centre;
  const Matrix3 turn = synthetic::turn({0, 1, 0}, 0.035);
  const RigidTransform seen = RigidTransform{turn, at - turn * at} * usual_pose();
  scene().see_body(seen);
  warp_to(seen);
  for (int frame = 0; frame < 5; ++frame) (void)scene().look_now();
  const FixedPose region(usual_pose(), scene().tables.centre);
  const ModelTables& model = scene().tables;
  std::size_t turned = 0;
  for (std::size_t i = 0; i < model.size; ++i) {
    if (scene().points.sight[i] != Sight::agrees) continue;
    const IntPoint p = region.point(model.x[i], model.y[i], model.z[i]);
    turned += faces_camera(p, region.direction(model.nx[i], model.ny[i], model.nz[i]), 0) ? 0U : 1U;
    EXPECT_EQ(scene().points.label[i], 0);
  }
  EXPECT_GE(turned, 3U);
}

TEST_F(Label, NothingIsObservedInAnEmptyPicture) {
  Picture picture(scene().camera);
  scene().see(picture);
  const SightCounts counts = frames(10);
  EXPECT_GT(counts.facing, 0U);
  EXPECT_EQ(counts.in_front + counts.behind, 0U);
  EXPECT_EQ(labels().at(kNotObserved), scene().tables.size);
}

TEST_F(Label, APointGoesOverToTheRegionThatExplainsIt) {
  // Region 1 has the true pose, the base is 2 cm off: points at the border go over.
  scene().see_body(usual_pose());
  scene().regions[1] = scene().regions[0];
  scene().regions[1].parent = 0;
  scene().regions[0].pose.translation.z() += 0.02;
  std::size_t before = 0;
  for (std::size_t i = 0; i < scene().tables.size; ++i) {
    scene().points.home[i] = scene().rest(i).x() > 0.05 ? 1 : 0;
    before += scene().points.home[i] == 1 ? 1U : 0U;
  }
  frames(1);
  std::size_t once = 0, later = 0;
  for (const std::int8_t home : scene().points.home) once += home == 1 ? 1U : 0U;
  EXPECT_LE(once, before + 5);  // temporal evidence first
  frames(12);
  for (const std::int8_t home : scene().points.home) later += home == 1 ? 1U : 0U;
  EXPECT_GT(later, before + 50);
}

TEST_F(Label, HomesOfUnseenPointsFollowTheSurface) {
  for (std::size_t i = 0; i < scene().tables.size; ++i) {
    const bool right = scene().rest(i).x() > 0;
    scene().points.sight[i] = std::abs(scene().rest(i).x()) > 0.09 ? Sight::agrees : Sight::none;
    scene().points.home[i] = scene().points.sight[i] == Sight::agrees && right ? 3 : 0;
  }
  carry_homes_to_unseen(scene().tables, scene().points);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < scene().tables.size; ++i) {
    if (std::abs(scene().rest(i).x()) < 0.02) continue;
    wrong += (scene().points.home[i] == 3) != (scene().rest(i).x() > 0) ? 1U : 0U;
  }
  EXPECT_LT(wrong, scene().tables.size / 50);
}

TEST_F(Label, ALookTellsFrontFromBehind) {
  Picture picture(scene().camera);
  picture.wall(0.9);
  scene().see(picture);
  const Sighting sighting(scene().tables, scene().surface, scene().projector, scene().tolerance);
  for (const double z : {0.7, 1.1}) {
    const FixedPose pose({usual_pose().rotation, {0, 0, z}}, scene().tables.centre);
    std::size_t facing = 0;
    for (std::size_t i = 0; i < scene().tables.size; ++i) {
      const Sighting::Look look = sighting.look(i, pose);
      if (!look.facing) continue;
      ++facing;
      ASSERT_EQ(look.sight, z < 0.9 ? Sight::in_front : Sight::behind);
      // Along a normal that is almost square to the line of sight, rounding decides.
      if (faces_camera(look.point, look.normal, 164)) {
        ASSERT_EQ(look.residual > 0, z > 0.9);
      }
    }
    EXPECT_GT(facing, 500U);
  }
}

}  // namespace
}  // namespace pliant

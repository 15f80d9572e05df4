#include "core/track/steady.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::degrees_between;
using synthetic::pose_at;

constexpr double kNoise = 0.001, kHalfRadius = 0.05;
const Vector3 kCentre(0.02, -0.01, 0.03);

RigidTransform start() {
  return pose_at({0.1, -0.05, 0.8}, {1, 2, 3}, 0.7);
}
RigidTransform shifted(const RigidTransform& pose, const Vector3& shift) {
  return {pose.rotation, pose.translation + shift};
}
RigidTransform turned(const RigidTransform& pose, double angle) {
  const Matrix3 turn = synthetic::turn({0.2, 1, -0.4}, angle);
  const Vector3 at = pose * kCentre;
  return RigidTransform{turn, at - turn * at} * pose;
}
RigidTransform steady(const RigidTransform& before, const RigidTransform& after, StepMemory& memory) {
  return steadied(before, after, kCentre, kHalfRadius, kNoise, memory);
}
/// The first step that is remembered.
RigidTransform steady(const RigidTransform& before, const RigidTransform& after) {
  StepMemory memory;
  return steady(before, after, memory);
}
double in_degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}
/// How far the centre went, metres.
double way(const RigidTransform& from, const RigidTransform& to) {
  return (to * kCentre - from * kCentre).norm();
}

TEST(Steadied, NothingMovesWhereNothingMoved) {
  const RigidTransform out = steady(start(), start());
  EXPECT_LT(way(start(), out), 1e-12);
  EXPECT_LT(degrees_between(out.rotation, start().rotation), 1e-9);
}

TEST(Steadied, AStepThatNoiseExplainsIsMostlySuppressed) {
  const Vector3 step(0.2 * kNoise, 0, 0);
  EXPECT_LT(way(start(), steady(start(), shifted(start(), step))), 0.05 * step.norm());
  const double angle = 0.2 * kNoise / kHalfRadius;
  const RigidTransform out = steady(start(), turned(start(), angle));
  EXPECT_LT(degrees_between(out.rotation, start().rotation), 0.05 * in_degrees(angle));
}

TEST(Steadied, HalfOfAStepThreeTimesTheNoiseIsTaken) {
  EXPECT_NEAR(way(start(), steady(start(), shifted(start(), {0, 3 * kNoise, 0}))), 1.5 * kNoise, 1e-9);
}

TEST(Steadied, TheFirstFramesAreTakenAsInAMean) {
  EXPECT_EQ(least_share(0), 1.0);
  EXPECT_EQ(least_share(1), 1.0);
  EXPECT_EQ(least_share(2), 0.5);
  EXPECT_EQ(least_share(kMisfitFirstFrames + 1), 0.0);
  const Vector3 step(0.1 * kNoise, 0, 0);
  const RigidTransform moved = shifted(start(), step);
  const auto taken = [&](double least) {
    StepMemory memory;
    return way(start(), steadied(start(), moved, kCentre, kHalfRadius, kNoise, memory, least));
  };
  EXPECT_NEAR(taken(1), step.norm(), 1e-12);
  EXPECT_NEAR(taken(0.5), 0.5 * step.norm(), 1e-12);
  EXPECT_LT(taken(0), 0.02 * step.norm());
}

TEST(Steadied, ALargeStepIsFollowed) {
  for (const double times : {10.0, 100.0}) {
    const RigidTransform moved = shifted(start(), Vector3(0, 0.6, 0.8) * (times * kNoise));
    EXPECT_LT(way(moved, steady(start(), moved)), 9 * kNoise / times * 1.01);
    const double angle = times * kNoise / kHalfRadius;
    const RigidTransform spun = turned(start(), angle);
    const RigidTransform out = steady(start(), spun);
    EXPECT_LT(way(spun, out), 1e-9) << "it turns about the centre";
    EXPECT_LT(degrees_between(out.rotation, spun.rotation) * kHalfRadius / in_degrees(1),
              9 * kNoise / times * 1.01);
  }
}

TEST(Steadied, LagsByLessThanTheNoiseBehindSteadyMotion) {
  for (const double speed : {0.1, 0.5, 1.0, 3.0, 20.0}) {
    RigidTransform truth = start(), out = start();
    StepMemory memory;
    double at_first = 0, later = 0;
    for (int frame = 0; frame < 300; ++frame) {
      truth = shifted(truth, {0.6 * speed * kNoise, 0, 0.8 * speed * kNoise});
      out = steady(out, truth, memory);
      double& lag = frame < 30 ? at_first : later;
      lag = std::max(lag, way(out, truth));
    }
    EXPECT_LT(later, kNoise) << speed;
    EXPECT_LT(at_first, 2 * kNoise) << speed;
  }
}

TEST(Steadied, HoldsStillWhatTrembles) {
  RigidTransform out = start();
  StepMemory memory;
  double most = 0;
  for (int frame = 0; frame < 200; ++frame) {
    const double side = frame % 2 == 0 ? 0.3 : -0.3;
    out = steady(out, shifted(start(), {side * kNoise, 0, 0}), memory);
    most = std::max(most, way(out, start()));
  }
  EXPECT_LT(most, 0.15 * 0.3 * kNoise);
}

TEST(Steadied, WhatIsAtRestHardlyWandersWithTheReadings) {
  RigidTransform out = start();
  StepMemory memory;
  double most = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const double wander = 0.4 * kNoise * std::sin(2 * std::numbers::pi * frame / 30);
    out = steady(out, shifted(start(), {wander, 0, 0}), memory);
    if (frame >= 60) most = std::max(most, way(out, start()));
  }
  EXPECT_LT(most, 0.02 * kNoise);
}

TEST(Steadied, WhatSetsOutFromRestIsFollowedAtOnce) {
  for (const double speed : {1.0, 3.0, 10.0}) {
    RigidTransform truth = start(), out = start();
    StepMemory memory;
    for (int frame = 0; frame < 60; ++frame) out = steady(out, truth, memory);
    double lag = 0;
    for (int frame = 0; frame < 30; ++frame) {
      truth = shifted(truth, {speed * kNoise, 0, 0});
      out = steady(out, truth, memory);
      lag = std::max(lag, way(out, truth));
    }
    EXPECT_LT(lag, 4 * kNoise) << speed;
  }
}

TEST(Steadied, LeavesAThirdOfNoiseAsLargeAsExpected) {
  std::mt19937 engine(7);
  RigidTransform out = start();
  StepMemory memory;
  double squares = 0, noise_squares = 0;
  for (int frame = 0; frame < 600; ++frame) {
    const auto some = [&] { return (static_cast<double>(engine()) / 4294967296.0 - 0.5) * 2 * kNoise; };
    const Vector3 noise(some(), some(), some());
    out = steady(out, shifted(start(), noise), memory);
    if (frame < 100) continue;
    squares += way(start(), out) * way(start(), out);
    noise_squares += noise.squaredNorm();
  }
  EXPECT_LT(9 * squares, noise_squares);
}

TEST(SpreadOfReadings, IsTheSensorsUnlessTheModelIsOffTheObject) {
  EXPECT_EQ(spread_of_readings(20, 0), 20);
  EXPECT_EQ(spread_of_readings(20, 20), 20);
  EXPECT_EQ(spread_of_readings(20, 50), 50);
  EXPECT_EQ(spread_of_readings(20, 500), 80) << "farther readings weigh nothing";
}

class HoldSteady : public synthetic::SharedScene<synthetic::bumpy_body> {};

TEST_F(HoldSteady, AStepIsJudgedByHowFarTheReadingsLieOffTheRegion) {
  const RigidTransform pose = synthetic::usual_pose();
  const auto depth = static_cast<std::int32_t>((pose * scene().model.centre()).z() * kUnitsPerMetre);
  const std::int32_t sigma = scene().surface.sigma(depth);
  // three times what is left of the sensor's noise: half of it counts
  const Vector3 step(3 * kNoiseOfPose * sigma / kUnitsPerMetre, 0, 0);
  const auto share_taken = [&](std::int32_t scale) {
    scene().place(pose);
    TrackedRegion& region = scene().regions[0];
    region.scale = scale;
    region.pose.translation += step;
    hold_steady(scene().tables, scene().surface, 2 * kMisfitFirstFrames, scene().regions);
    return (region.pose.translation - pose.translation).norm() / step.norm();
  };
  EXPECT_NEAR(share_taken(0), 0.5, 0.01);
  EXPECT_NEAR(share_taken(sigma / 2), 0.5, 0.01);
  EXPECT_NEAR(share_taken(3 * sigma), 0.1, 0.01);
  EXPECT_NEAR(share_taken(100 * sigma), 1.0 / 17, 0.01);
}

}  // namespace
}  // namespace pliant

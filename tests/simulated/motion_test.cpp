#include "drivers/simulated/motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <numbers>

namespace pliant::simulated {
namespace {

TEST(Motion, SineAndCosineAgreeWithTheLibrary) {
  for (int i = -2000; i <= 2000; ++i) {
    const double turns = i * 0.00137;
    EXPECT_NEAR(sine(turns), std::sin(2 * std::numbers::pi * turns), 1e-11) << turns;
    EXPECT_NEAR(cosine(turns), std::cos(2 * std::numbers::pi * turns), 1e-11) << turns;
  }
}

TEST(Motion, RotationsAreProperAndOfTheRightAngle) {
  const Vector3 axis = Vector3(1, -2, 0.5).normalized();
  const Matrix3 r = rotation_about(axis, kDegree * 30);
  EXPECT_LT((r * r.transpose() - Matrix3::Identity()).norm(), 1e-12);
  EXPECT_NEAR(r.determinant(), 1, 1e-12);
  EXPECT_NEAR(cos_angle(r), std::cos(std::numbers::pi / 6), 1e-12);
  EXPECT_LT((r * axis - axis).norm(), 1e-12);
  // Right-handed: a quarter turn about z takes x to y.
  EXPECT_LT((rotation_about(Vector3::UnitZ(), 0.25) * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-11);
}

TEST(Motion, AHingeLeavesItsAxisInPlace) {
  const Vector3 point(0.1, 0.2, -0.3);
  const RigidTransform turn = hinge(point, Vector3::UnitY(), 0.2);
  EXPECT_LT((turn * point - point).norm(), 1e-12);
  EXPECT_LT((turn * Vector3(point + Vector3::UnitY()) - point - Vector3::UnitY()).norm(), 1e-12);
}

TEST(Motion, GlidesStartAndEndAtRestWithBoundedSpeed) {
  double before = glide(0, 10, 50);
  EXPECT_EQ(before, 0);
  double fastest = 0;
  for (double phase = 0; phase <= 60; phase += 0.5) {
    const double now = glide(phase, 10, 50);
    EXPECT_GE(now, before);
    fastest = std::max(fastest, (now - before) / 0.5 * 40);
    before = now;
  }
  EXPECT_EQ(before, 1);
  EXPECT_NEAR(fastest, 8.0 / 7, 0.01);
  EXPECT_LT(glide(10.5, 10, 50), 0.002);
  EXPECT_EQ(there_and_back(30, 0, 20, 40, 60), 1);
  EXPECT_EQ(there_and_back(60, 0, 20, 40, 60), 0);
}

TEST(Motion, SwayReturns) {
  for (const int cycles : {1, 2, 3}) {
    EXPECT_NEAR(sway(0, 285, cycles), 0, 1e-12);
    EXPECT_NEAR(sway(285, 285, cycles), 0, 1e-12);
    EXPECT_NEAR(sway(285.0 / (2 * cycles), 285, cycles), 1, 1e-12);
  }
}

}  // namespace
}  // namespace pliant::simulated

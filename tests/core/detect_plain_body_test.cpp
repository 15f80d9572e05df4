// Plain bodies fitted to points, and what they say of a pose.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/camera/surface.hpp"
#include "core/detect/flat_faces.hpp"
#include "core/detect/plain_body.hpp"
#include "core/detect/pose_candidates.hpp"
#include "core/detect/quadric.hpp"
#include "core/detect/self_likeness.hpp"
#include "tests/core/bumpy_object.hpp"
#include "tests/frame_of.hpp"

namespace pliant {
namespace {

constexpr double kNoise = 0.01;

/// Points around the upper half of a ball of radius 1, scaled along the axes, with noise.
std::vector<Vector3> cap(const Vector3& scale, const Vector3& middle, double noise) {
  std::mt19937 random(7);
  std::normal_distribution<double> spread(0, noise);
  std::vector<Vector3> points;
  for (int i = 0; i < 300; ++i) {
    const double z = (i + 0.5) / 300, r = std::sqrt(1 - z * z), a = 2.4 * i;
    points.push_back(middle + Vector3(scale.x() * r * std::cos(a) + spread(random),
                                      scale.y() * r * std::sin(a) + spread(random),
                                      scale.z() * z + spread(random)));
  }
  return points;
}

double mean_square(QuadricFit& fit, const std::vector<Vector3>& points) {
  for (const Vector3& p : points) fit.add(p);
  EXPECT_TRUE(fit.solve());
  double sum = 0;
  for (const Vector3& p : points) sum += fit.squared_distance(p, 1);
  return sum / static_cast<double>(points.size());
}

TEST(QuadricFit, LeavesTheNoiseOfAnEllipsoid) {
  QuadricFit fit;
  const double left = mean_square(fit, cap({0.8, 0.5, 0.6}, {0.2, -0.1, 0.3}, kNoise));
  EXPECT_GT(left, 0.7 * kNoise * kNoise);
  EXPECT_LT(left, 1.2 * kNoise * kNoise);
  EXPECT_NEAR(fit.squared_distance({0.2, -0.1, 1.0}, 1), 0.01, 0.004);  // 0.1 above its top
  EXPECT_DOUBLE_EQ(fit.squared_distance({5, 5, 5}, 0.5), 0.25);
}

TEST(QuadricFit, HoldsAPlaneWithoutNoiseToo) {
  QuadricFit fit;
  EXPECT_LT(mean_square(fit, cap({0.8, 0.5, 0}, Vector3::Zero(), 0)), 1e-6);
}

TEST(QuadricFit, NoPointsHaveNoAnswerAndDoNoHarm) {
  QuadricFit fit;
  EXPECT_FALSE(fit.solve());
}

/// Three faces of a box around its corner at the origin, with noise along their normals.
std::vector<OrientedReading> corner() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(-1, 0);
  std::normal_distribution<double> spread(0, kNoise);
  std::vector<OrientedReading> readings;
  for (int i = 0; i < 300; ++i) {
    OrientedReading r{{along(random), along(random), along(random)}, Vector3::Zero()};
    r.point(i % 3) = spread(random);
    r.normal(i % 3) = 1;
    readings.push_back(r);
  }
  return readings;
}

TEST(FlatFaces, FindsTheFacesOfABox) {
  const std::vector<OrientedReading> readings = corner();
  FlatFaces faces;
  faces.start(readings);
  faces.fit(readings);
  EXPECT_EQ(faces.count(), 3U);
  double sum = 0;
  for (const OrientedReading& r : readings) sum += faces.squared_distance(r.point, 1);
  EXPECT_LT(sum / 300, 1.2 * kNoise * kNoise);
}

TEST(FlatFaces, WithoutNormalsThereAreNone) {
  std::vector<OrientedReading> readings = corner();
  for (OrientedReading& r : readings) r.normal = Vector3::Zero();
  FlatFaces faces;
  faces.start(readings);
  faces.fit(readings);
  EXPECT_EQ(faces.count(), 0U);
  EXPECT_DOUBLE_EQ(faces.squared_distance({0, 0, 0}, 0.5), 0.25);
}

/// A box of 0.2 × 0.14 × 0.16 m whose faces bulge by `bulge` in their middles, `side`² points a face.
testing::TestCloud box(int side, double bulge) {
  const Vector3 half(0.1, 0.07, 0.08);
  testing::TestCloud cloud;
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < side * side; ++i) {
      const double a = (i / side + 0.5) / side * 2 - 1, b = (i % side + 0.5) / side * 2 - 1;
      const int axis = face / 2, next = (axis + 1) % 3, last = (axis + 2) % 3;
      const double sign = face % 2 == 0 ? 1 : -1;
      Vector3 p, n;
      p(axis) = sign * (half(axis) + bulge * (1 - a * a) * (1 - b * b));
      p(next) = a * half(next);
      p(last) = b * half(last);
      n(axis) = sign;
      n(next) = 2 * bulge * a * (1 - b * b) / half(next);
      n(last) = 2 * bulge * b * (1 - a * a) / half(last);
      cloud.positions.push_back(to_point(p));
      cloud.normals.push_back(testing::normal16(n));
    }
  return cloud;
}

/// How a plain body and the model explain the picture of a true box.
PlainBodyFit fit_to_box(const testing::TestCloud& cloud) {
  const Intrinsics camera = testing::small_camera();
  const RigidTransform pose = testing::test_pose(0.9, Vector3(1, 0.7, 0.2), Vector3(0.02, -0.01, 0.7));
  const std::vector<std::uint16_t> picture =
      testing::depth_picture(camera, testing::moved(box(150, 0), pose), 1.2, 1, 0.0012);
  const testing::TestModel model(cloud, 64);
  EXPECT_EQ(model.fault(), ModelFault::none);
  const testing::AlignedBlock block(8 << 20);
  Workspace workspace(block.span());
  Surface surface;
  DepthSnapshot snapshot;
  ProbePoints points;
  surface.lay_out(workspace, camera);
  snapshot.lay_out(workspace, camera);
  points.lay_out(workspace, kMostPlainPoints);
  EXPECT_FALSE(workspace.exhausted());
  surface.start(camera, SensorDescription());
  surface.build(test::frame_of(picture, camera), {0, 0, camera.width, camera.height});
  snapshot.start(camera, SensorDescription());
  snapshot.take(surface);
  snapshot.compute_normals(0, snapshot.lattice_height(), 0.01);
  points.start(model.view());
  return plain_body_fit(points, snapshot, pose, kMostPlainPoints, 0.006, 0.02);
}

TEST(PlainBodyFit, FacesAreNearerToABoxThanAModelWithRoundSides) {
  const PlainBodyFit fit = fit_to_box(box(16, 0.008));
  EXPECT_GT(fit.readings, 100);
  EXPECT_TRUE(fit.faces_are_nearer());
}

TEST(PlainBodyFit, NoFacesAreNearerToABoxThanAModelThatHasThemItself) {
  const PlainBodyFit fit = fit_to_box(box(16, 0));
  EXPECT_GT(fit.readings, 100);
  EXPECT_FALSE(fit.faces_are_nearer());
  EXPECT_FALSE(fit.pieces_explain());
}

TEST(SelfLikeness, ABallLooksAlikeFromEverywhereTheObjectOnlyUnmoved) {
  testing::TestCloud ball = testing::bumpy_cloud(1500);
  for (std::size_t i = 0; i < ball.positions.size(); ++i) {
    const Vector3 d = to_vector(ball.positions[i]).normalized();
    ball.positions[i] = to_point(0.1 * d);
    ball.normals[i] = testing::normal16(d);
  }
  const testing::TestModel round(ball, 64);
  ASSERT_EQ(round.fault(), ModelFault::none);
  const RigidTransform turn = testing::test_pose(1.3, Vector3(0.3, 1, -0.2), Vector3::Zero());
  EXPECT_GT(self_likeness(round.view(), turn, 128, 0.003), 0.99);
  EXPECT_LT(self_likeness(testing::bumpy_model(), turn, 128, 0.003), 0.6);
  EXPECT_EQ(self_likeness(testing::bumpy_model(), RigidTransform(), 128, 0.003), 1);
}

Detection strong(double model, double quadric, double faces, double noise) {
  Detection d;
  d.score = 0.8;
  d.evidence.facing = 200;
  d.evidence.agreeing = 180;
  d.evidence.close = 170;
  d.plain = {180, model * model, quadric * quadric, 100, faces * faces, noise * noise};
  return d;
}

TEST(Verdict, WhatAPlainBodyExplainsBetterIsNotTheObject) {
  EXPECT_TRUE(verdict_on(strong(1, 2, 3, 1)).convincing);
  EXPECT_FALSE(needs_other_attitudes(strong(1, 2, 3, 1)));
  EXPECT_FALSE(verdict_on(strong(2, 1, 3, 1)).convincing);    // a ball
  EXPECT_FALSE(verdict_on(strong(2, 3, 0.5, 1)).convincing);  // a box
  EXPECT_TRUE(needs_other_attitudes(strong(2, 3, 0.5, 1)));
  EXPECT_TRUE(verdict_on(strong(2, 1.8, 1.8, 1)).convincing);  // not clearly nearer
}

TEST(Verdict, WithinNoiseAPlainBodyCountsOnceTheObjectFitsInOtherAttitudesToo) {
  Detection d = strong(0.9, 0.5, 3, 1);
  EXPECT_TRUE(verdict_on(d).convincing);
  EXPECT_TRUE(needs_other_attitudes(d));
  d.twin = 0.7;  // in which it looks the same: a book
  EXPECT_TRUE(verdict_on(d).convincing);
  d.other = 0.7;
  EXPECT_FALSE(verdict_on(d).convincing);
}

TEST(Verdict, PiecesThatAreNotCloseCountOnceTheObjectFitsInOtherAttitudesToo) {
  Detection d = strong(2, 3, 1.4, 1);
  EXPECT_TRUE(verdict_on(d).convincing);
  d.twin = 0.7;
  EXPECT_FALSE(verdict_on(d).convincing);
}

}  // namespace
}  // namespace pliant

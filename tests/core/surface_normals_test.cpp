// Vertices and normals of the observed surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/camera/surface.hpp"
#include "tests/core/observed_surface.hpp"

namespace pliant {
namespace {

using synthetic::degrees;
using synthetic::Observed;
using synthetic::Picture;

Vector3 ray(const Intrinsics& c, int u, int v) {
  return {(u - c.cx) / c.fx, (v - c.cy) / c.fy, 1};
}

Vector3 metres(const IntPoint& p) {
  return Vector3(p.x, p.y, p.z) / kUnitsPerMetre;
}

TEST(Surface, FindsVerticesAndNormalsOfATiltedPlane) {
  const Intrinsics camera = synthetic::small_camera();
  const Vector3 normal = Vector3(0.4, -0.3, -1).normalized();  // towards the camera
  const double offset = normal.dot(Vector3(0, 0, 0.9));
  Picture picture(camera);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      picture.block(u, v, u + 1, v + 1, offset / normal.dot(ray(camera, u, v)));
  Observed o;
  o.build(picture);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const std::uint16_t z8 = o.surface.depth(u, v);
      ASSERT_GT(z8, 0) << u << " " << v;
      const Vector3 p = metres(o.surface.vertex(u, v, z8));
      // half a millimetre of the reading, more where the mean is one-sided at the border
      const bool inner = u > 0 && v > 0 && u + 1 < camera.width && v + 1 < camera.height;
      ASSERT_NEAR(normal.dot(p), offset, inner ? 0.0006 : 0.0025) << u << " " << v;
      Normal16 n;
      ASSERT_TRUE(o.surface.normal(u, v, 4, n));
      ASSERT_LT(degrees(n, normal), inner ? 4.0 : 12.0) << u << " " << v;
      ASSERT_NEAR(std::sqrt(double(n.x) * n.x + double(n.y) * n.y + double(n.z) * n.z), 16384, 4);
    }
}

TEST(Surface, FindsNormalsOfASphere) {
  const Intrinsics camera{640, 480, 575, 575, 319.5, 239.5, 10000};
  const Vector3 centre(0.05, -0.04, 0.8);
  constexpr double kRadius = 0.15;
  Picture picture(camera);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Vector3 d = ray(camera, u, v);
      const double b = d.dot(centre),
                   disc = b * b - d.squaredNorm() * (centre.squaredNorm() - kRadius * kRadius);
      if (disc > 0) picture.block(u, v, u + 1, v + 1, (b - std::sqrt(disc)) / d.squaredNorm());
    }
  Observed o(camera);
  o.build(picture);
  int looked = 0;
  for (int v = 0; v < camera.height; v += 3)
    for (int u = 0; u < camera.width; u += 3) {
      const std::uint16_t z8 = o.surface.depth(u, v);
      if (z8 == 0) continue;
      const Vector3 p = metres(o.surface.vertex(u, v, z8)), outward = (p - centre).normalized();
      const double steepness = -outward.dot(p.normalized());
      if (steepness < 0.4) continue;
      EXPECT_NEAR((p - centre).norm(), kRadius, 0.0008);
      Normal16 n;
      ASSERT_TRUE(o.surface.normal(u, v, 3, n));
      EXPECT_LT(degrees(n, outward), 3.0) << u << " " << v;
      const IntPoint along{static_cast<std::int32_t>(outward.x() * 16384),
                           static_cast<std::int32_t>(outward.y() * 16384),
                           static_cast<std::int32_t>(outward.z() * 16384)};
      EXPECT_TRUE(o.surface.faces(u, v, 3, along));
      EXPECT_FALSE(o.surface.faces(u, v, 3, {-along.x, -along.y, -along.z}));
      ++looked;
    }
  EXPECT_GT(looked, 2000);
}

TEST(Surface, NormalsAreOfTheLatestPictureHoweverManyWereBefore) {
  const Intrinsics camera = synthetic::small_camera();
  const auto slope = [&](double per_pixel) {
    Picture picture(camera);
    for (int u = 0; u < camera.width; ++u) picture.block(u, 0, u + 1, camera.height, 0.8 + per_pixel * u);
    return picture;
  };
  Picture one = slope(0.0005), other = slope(-0.0005);
  Observed o;
  const Window window{154, 114, 166, 126};
  // the numbers that pictures bear begin anew after 4095
  for (const int times : {1, 4094, 4095, 4096}) {
    Normal16 before, after;
    o.surface.build(one.frame(), window);
    ASSERT_TRUE(o.surface.normal(160, 120, 2, before));
    for (int i = 0; i < times; ++i) o.surface.build(other.frame(), window);
    ASSERT_TRUE(o.surface.normal(160, 120, 2, after));
    EXPECT_LT(before.x * after.x, 0) << times;
  }
}

TEST(Surface, FacesMeansWithinSixtyDegrees) {
  Picture picture(synthetic::small_camera());
  picture.wall(1.0);
  Observed o;
  o.build(picture);
  for (int angle = -170; angle <= 180; angle += 10) {
    const double a = angle * 3.14159265 / 180;
    const IntPoint direction{static_cast<std::int32_t>(16384 * std::sin(a)), 0,
                             static_cast<std::int32_t>(-16384 * std::cos(a))};
    if (std::abs(angle) == 60) continue;
    EXPECT_EQ(o.surface.faces(160, 120, 2, direction), std::abs(angle) < 60) << angle;
  }
}

TEST(Surface, ExtremeReadingsAndCamerasStayInBounds) {
  // what the sanitizers watch: wild depth under the widest and the longest lens that is let in
  std::mt19937 random(8);
  for (const double focal : {10.0, 100.0, 10000.0}) {
    const double aside = focal > 1000 ? 8000 : 31 - kMostSlope * focal;
    const Intrinsics camera{32, 24, focal, focal, aside, 12, 8000};
    ASSERT_EQ(intrinsics_fault(camera), nullptr);
    Observed o(camera, Kernels::automatic, {0.05, 0.1, 0.05, 8.0});
    std::vector<std::uint16_t> raw(32 * 24);
    for (std::uint16_t& x : raw)
      x = static_cast<std::uint16_t>(random() % 2 == 0 ? 64000 - random() % 9000 : random());
    o.surface.build({raw.data(), 32, 24, 32, 0, 0}, {0, 0, 32, 24});
    for (int v = 0; v < 24; ++v)
      for (int u = 0; u < 32; ++u)
        for (int step = 1; step <= Surface::kMostStep; ++step) {
          Normal16 n;
          if (!o.surface.normal(u, v, step, n)) continue;
          const double square = double(n.x) * n.x + double(n.y) * n.y + double(n.z) * n.z;
          ASSERT_NEAR(std::sqrt(square), 16384, 8);
          (void)o.surface.faces(u, v, step, {n.x, n.y, n.z});
          (void)o.surface.vertex(u, v, o.surface.depth(u, v));
        }
  }
}

TEST(Surface, NormalStepSpansTheLength) {
  Observed o;
  const auto step = [&](std::uint16_t z8, double metres) {
    return Surface::normal_step(z8, o.surface.pixel_span(metres));
  };
  EXPECT_EQ(step(0, 0.005), 1);
  EXPECT_EQ(step(8000, 0.0), 1);
  EXPECT_EQ(step(8000, 0.010), 3);  // 290 px · 1 cm at 1 m
  EXPECT_EQ(step(4000, 0.010), 6);
  EXPECT_EQ(step(1, 5.0), Surface::kMostStep);
  EXPECT_EQ(step(65535, 1e9), Surface::kMostStep);
}

}  // namespace
}  // namespace pliant

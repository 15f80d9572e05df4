#include "core/track/model_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/core/synthetic.hpp"
#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::TrackScene;

class Random {
 public:
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }

 private:
  std::mt19937 engine_{21};
};

TEST(ModelTables, HoldThePointsToHalfAUnit) {
  TrackScene scene(synthetic::bumpy_body());
  ASSERT_EQ(scene.tables.size, scene.model.size());
  ASSERT_GT(scene.tables.size, 1000U);
  for (std::size_t i = 0; i < scene.tables.size; ++i) {
    const Vector3 off = (scene.rest(i) - scene.tables.centre) * kUnitsPerMetre -
                        Vector3(scene.tables.x[i], scene.tables.y[i], scene.tables.z[i]);
    ASSERT_LE(off.cwiseAbs().maxCoeff(), 0.501);
    const double length = std::hypot(scene.tables.nx[i], scene.tables.ny[i], scene.tables.nz[i]);
    ASSERT_NEAR(length, 16384, 3);
  }
  EXPECT_NEAR(scene.tables.spacing, scene.model.spacing() * kUnitsPerMetre, 0.51);
}

TEST(FixedPose, FollowsTheDoubleOneWithinItsBound) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 axis(random(-1, 1), random(-1, 1), random(-1, 1));
    const RigidTransform pose =
        synthetic::pose_at({random(-3, 3), random(-3, 3), random(0.3, 8)},
                           axis.norm() < 0.1 ? Vector3(0, 0, 1) : axis, random(-3.1, 3.1));
    const Vector3 centre(random(-5, 5), random(-5, 5), random(-5, 5));
    const FixedPose fixed(pose, centre);
    // up to the corners of the largest model
    const int x = static_cast<int>(random(-32000, 32000)), y = static_cast<int>(random(-32000, 32000)),
              z = static_cast<int>(random(-32000, 32000));
    const Vector3 local(x, y, z);
    const Vector3 exact = (pose * (centre + local / kUnitsPerMetre)) * kUnitsPerMetre;
    const IntPoint got = fixed.point(x, y, z);
    const double bound = 1.01 + local.cwiseAbs().sum() / 32768;
    ASSERT_LT((exact - Vector3(got.x, got.y, got.z)).cwiseAbs().maxCoeff(), bound);
    const Vector3 normal = Vector3(random(-1, 1), random(-1, 1), random(0.1, 1)).normalized();
    const IntPoint n =
        fixed.direction(static_cast<int>(normal.x() * 16384), static_cast<int>(normal.y() * 16384),
                        static_cast<int>(normal.z() * 16384));
    ASSERT_LT((pose.rotation * normal * 16384 - Vector3(n.x, n.y, n.z)).cwiseAbs().maxCoeff(), 4);
  }
}

/// The pixel in double precision.
void expect_pixel(const Intrinsics& camera, const Projector& projector, const IntPoint& p) {
  const double u = camera.fx * p.x / p.z + camera.cx, v = camera.fy * p.y / p.z + camera.cy;
  int gu = -1, gv = -1;
  const bool inside = projector.project(p, gu, gv);
  if (u > 1 && v > 1 && u < camera.width - 2 && v < camera.height - 2) {
    ASSERT_TRUE(inside) << u << " " << v;
    constexpr double slack =
        0.76;  // half a pixel, and the rounding of focal length, offset and centre to 1/8
    ASSERT_NEAR(gu, u, slack);
    ASSERT_NEAR(gv, v, slack);
  } else if (u < -2 || v < -2 || u > camera.width + 1 || v > camera.height + 1) {
    ASSERT_FALSE(inside) << u << " " << v;
  }
}

TEST(Projector, FindsTheNearestPixel) {
  Random random;
  for (const Intrinsics& camera :
       {synthetic::small_camera(), Intrinsics{640, 480, 575.8, 574.2, 314.3, 235.9, 1000},
        Intrinsics{1920, 1200, 1900, 1900, 960, 600, 1000},
        Intrinsics{1920, 1200, 10000, 10000, 960, 600, 1000}, Intrinsics{64, 48, 20, 20, 31.5, 23.5, 1000}}) {
    ASSERT_EQ(intrinsics_fault(camera), nullptr);
    Projector projector;
    projector.start(camera);
    for (int i = 0; i < 5000; ++i) {
      const double z = random(900, 128000);
      const double x = (random(-50, camera.width + 50) - camera.cx) * z / camera.fx;
      const double y = (random(-50, camera.height + 50) - camera.cy) * z / camera.fy;
      expect_pixel(
          camera, projector,
          {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)});
    }
  }
}

TEST(Projector, RefusesWhatLiesOutOfRange) {
  for (const double focal : {10.0, 575.0, 10000.0}) {
    Projector projector;
    projector.start({640, 480, focal, focal, 320, 240, 1000});
    int u = 0, v = 0;
    EXPECT_TRUE(projector.project({0, 0, 800}, u, v));
    EXPECT_TRUE(projector.project({0, 0, 128000}, u, v));
    EXPECT_FALSE(projector.project({0, 0, 799}, u, v));
    EXPECT_FALSE(projector.project({0, 0, 128001}, u, v));
    EXPECT_FALSE(projector.project({0, 0, 0}, u, v));
    EXPECT_FALSE(projector.project({0, 0, -5000}, u, v));
    for (const std::int32_t far : {128000, 128001, 1 << 30, -128000, -128001, -(1 << 30)}) {
      const double aside = std::abs(static_cast<double>(far)) / 128000 * focal;  // pixels
      EXPECT_EQ(projector.project({far, 0, 128000}, u, v), aside < 320) << far << " " << focal;
      EXPECT_EQ(projector.project({0, far, 128000}, u, v), aside < 240) << far << " " << focal;
    }
  }
}

TEST(Projector, TellsHowManyPixelsALengthSpans) {
  Projector projector;
  projector.start({640, 480, 600, 600, 320, 240, 1000});
  EXPECT_EQ(projector.pixels(160, 16000), 7);  // 10 mm at 1 m: 6 pixels, rounded up
  EXPECT_EQ(projector.pixels(0, 16000), 1);
  projector.start({640, 480, 6000, 6000, 320, 240, 1000});
  EXPECT_EQ(projector.pixels(160, 16000), 61);
}

TEST(Projector, SpansLengthsAtEveryDepth) {
  Projector projector;
  projector.start({640, 480, 10000, 10000, 320, 240, 1000});
  constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min();
  for (const std::int32_t z : {1, 0, -1, -16000, kLowest}) {
    EXPECT_EQ(projector.pixels(160, z), 1600001) << z;
    EXPECT_EQ(projector.pixels(1 << 17, z), (1 << 17) * 10000 + 1) << z;
    EXPECT_EQ(projector.length(256, z), 0) << z;
  }
  EXPECT_EQ(projector.length(256, 160000), 16);
}

}  // namespace
}  // namespace pliant

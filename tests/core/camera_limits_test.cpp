// Which cameras and sensors are let in, and that the integers hold all of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/camera/intrinsics.hpp"
#include "core/track/contour.hpp"
#include "core/track/track_state.hpp"
#include "tests/core/observed_surface.hpp"

namespace pliant {
namespace {

using synthetic::Observed;

TEST(CameraLimits, RefusesWhatLooksTooFarAside) {
  // 40 px of focal length at 320 px: up to a slope of 4
  const char* fault = intrinsics_fault({320, 240, 40, 40, 159.5, 119.5, 1000});
  ASSERT_NE(fault, nullptr);
  EXPECT_NE(std::strstr(fault, "-2 to 2"), nullptr) << fault;
  EXPECT_NE(intrinsics_fault({1920, 1200, 10, 10, -4000, 600, 1000}), nullptr);
  const Intrinsics widest{321, 241, 80, 60, 160, 120, 1000};
  EXPECT_EQ(intrinsics_fault(widest), nullptr);
  for (double Intrinsics::*member : {&Intrinsics::cx, &Intrinsics::cy})
    for (const double by : {-0.01, 0.01}) {
      Intrinsics aside = widest;
      aside.*member += by;
      EXPECT_NE(intrinsics_fault(aside), nullptr) << by;
    }
}

/// Calls `take` with cameras from the widest to the longest lens, looking ahead and aside.
template <typename Take>
void for_cameras(Take take) {
  for (const double focal : {10.0, 16.0, 40.0, 80.0, 300.0, 10000.0})
    for (const double aside : {0.0, -0.9, 0.9})
      for (const int width : {32, 320, 1920}) {
        const int height = width * 3 / 4 < limits::kMaxFrameHeight ? width * 3 / 4 : limits::kMaxFrameHeight;
        const Intrinsics camera{
            width, height, focal, focal, 0.5 * (width - 1) + aside * focal, 0.5 * (height - 1), 1000};
        if (intrinsics_fault(camera) == nullptr) take(camera);
      }
}

TEST(CameraLimits, WhereAReadingLiesItFallsAgain) {
  int cameras = 0;
  for_cameras([&](const Intrinsics& camera) {
    ++cameras;
    Observed o(camera);
    Projector projector;
    projector.start(camera);
    const int last_u = camera.width - 1, last_v = camera.height - 1;
    for (const int u : {0, last_u / 2, last_u})
      for (const int v : {0, last_v / 2, last_v})
        for (const std::uint16_t z8 : {std::uint16_t{2400}, std::uint16_t{8000}, std::uint16_t{64000}}) {
          const IntPoint p = o.surface.vertex(u, v, z8);
          EXPECT_NEAR(p.x, (u - camera.cx) / camera.fx * p.z, 1 + p.z * 0x1p-14);
          EXPECT_NEAR(p.y, (v - camera.cy) / camera.fy * p.z, 1 + p.z * 0x1p-14);
          // long lenses have pixels finer than the unit of points
          const double slack = 1 + camera.fx * (1.0 / p.z + 0x1p-14);
          std::int32_t fine_u = 0, fine_v = 0;
          ASSERT_TRUE(projector.project_finely(p, fine_u, fine_v));
          EXPECT_NEAR(fine_u / 256.0 - 0.5, u, slack);
          EXPECT_NEAR(fine_v / 256.0 - 0.5, v, slack);
        }
  });
  EXPECT_GE(cameras, 12);
}

TEST(SensorLimits, RefusesWhatIsOutOfItsRange) {
  using D = SensorDescription;
  EXPECT_EQ(sensor_fault({}), nullptr);
  EXPECT_EQ(sensor_fault({0.0001, 0, 0.05, 0.2}), nullptr);
  EXPECT_EQ(sensor_fault({0.05, 0.1, 4, 8}), nullptr);
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinite = std::numeric_limits<double>::infinity();
  struct Number {
    double D::*member;
    D::Range range;
    const char* name;
  };
  for (const Number& number : {Number{&D::noise_floor, D::kNoiseFloor, "noise_floor"},
                               Number{&D::noise_growth, D::kNoiseGrowth, "noise_growth"},
                               Number{&D::near_limit, D::kNearLimit, "near_limit"},
                               Number{&D::far_limit, D::kFarLimit, "far_limit"}})
    for (const double wrong : {nan, infinite, -infinite, number.range.low - 1e-6, number.range.high + 1e-6}) {
      D sensor;
      sensor.*number.member = wrong;
      const char* fault = sensor_fault(sensor);
      ASSERT_NE(fault, nullptr) << number.name << " " << wrong;
      EXPECT_EQ(std::strstr(fault, number.name), fault) << fault;
    }
  for (const double far : {2.0, 1.9}) {
    const char* fault = sensor_fault({0.001, 0.002, 2.0, far});
    ASSERT_NE(fault, nullptr);
    EXPECT_NE(std::strstr(fault, "less than"), nullptr) << fault;
  }
}

TEST(CameraLimits, OutlinesAreLookedForInTheWidestPicture) {
  // what the sanitizers watch: normals straight across and along the farthest rays
  for_cameras([&](const Intrinsics& camera) {
    Observed o(camera);
    Projector projector;
    projector.start(camera);
    for (const int u : {0, camera.width - 1})
      for (const int v : {0, camera.height - 1})
        for (const std::int32_t nz : {-16384, 0, 16384})
          for (const std::int32_t nx : {-16384, 0, 16384}) {
            std::int32_t distance = 0;
            EXPECT_FALSE(find_contour(o.surface, projector, {kFarthestReading, kFarthestReading},
                                      o.surface.vertex(u, v, 8000), {nx, 0, nz}, distance));
          }
  });
}

}  // namespace
}  // namespace pliant

// The sensor model on scenes that can be reckoned by hand.
#include "drivers/simulated/structure_sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace pliant::simulated {
namespace {

const Intrinsics kCamera{640, 480, 570, 570, 320, 240, 1000};

/// A wall that faces the camera, and what stands before it.
DisparityImage wall(double z) {
  DisparityImage image(kCamera);
  image.draw_plane(
      Vector3::UnitZ(), z, [](const Vector3&, const void*) { return true; }, nullptr);
  return image;
}

std::vector<std::uint16_t> measure(StructureSensor& sensor, const DisparityImage& scene,
                                   std::int64_t number) {
  std::vector<std::uint16_t> depth(std::size_t{640} * 480);
  sensor.measure(scene, number, depth);
  return depth;
}

TEST(StructureSensor, DepthComesInEighthsOfAPixelOfDisparity) {
  StructureSensor sensor(kCamera, {}, 1);
  std::set<int> possible{0};
  for (int eighths = 1; eighths < 1200; ++eighths)
    possible.insert(static_cast<int>(std::lround(8 * 42750.0 / eighths)));
  for (const double z : {0.5, 0.7, 1.3, 2.2})
    for (const std::uint16_t d : measure(sensor, wall(z), 3)) ASSERT_TRUE(possible.count(d)) << d;
}

TEST(StructureSensor, SpreadIsThatOfTheDescriptionAndUnbiased) {
  const SensorDescription description;
  for (const double z : {0.5, 0.7, 0.9, 1.2, 1.6}) {
    StructureSensor sensor(kCamera, description, 7);
    const DisparityImage scene = wall(z);
    double sum = 0;
    double squares = 0;
    double count = 0;
    for (int number = 0; number < 4; ++number)
      for (const std::uint16_t d : measure(sensor, scene, number)) {
        if (d == 0) continue;
        sum += d * 0.001 - z;
        squares += (d * 0.001 - z) * (d * 0.001 - z);
        count += 1;
      }
    // The published spread is the whole of fixed and flickering error; rounding to steps is part of it.
    EXPECT_NEAR(std::sqrt(squares / count) / description.sigma(z), 1.0, 0.2) << z;
    EXPECT_LT(std::fabs(sum / count), 0.3 * description.sigma(z)) << z;
    EXPECT_GT(count, 0.97 * 4 * 640 * 480);
  }
}

TEST(StructureSensor, ShadowLiesLeftOfNearThingsAndIsAsWideAsTheBaseLineHasIt) {
  DisparityImage scene = wall(1.2);
  const double half = 0.1;
  const std::array<Vector3, 4> corners{Vector3(-half, -half, 0.7), Vector3(-half, half, 0.7),
                                       Vector3(half, half, 0.7), Vector3(half, -half, 0.7)};
  const std::array<std::array<std::uint32_t, 3>, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  scene.draw(corners, triangles, {});
  StructureSensor sensor(kCamera, {}, 1);
  const std::vector<std::uint16_t> depth = measure(sensor, scene, 0);
  const double left_edge = 320 - 570 * half / 0.7;
  const double right_edge = 320 + 570 * half / 0.7;
  const double geometric = kFocalBaseline * (1 / 0.7 - 1 / 1.2);  // 25 pixels
  double left_gap = 0;
  double right_gap = 0;
  for (std::size_t v = 190; v < 290; ++v)
    for (std::size_t column = 150; column < 500; ++column) {
      if (depth[v * 640 + column] != 0) continue;
      const auto u = static_cast<double>(column);
      left_gap += u < left_edge + 5 && u > left_edge - geometric - 10 ? 0.01 : 0;
      right_gap += u > right_edge - 5 && u < right_edge + geometric + 10 ? 0.01 : 0;
    }
  EXPECT_NEAR(left_gap, geometric + 3, 2);
  EXPECT_LT(right_gap, 5);
  EXPECT_GT(right_gap, 0.5);
}

TEST(StructureSensor, SameSeedAndNumberGiveTheSameBytesInAnyOrder) {
  const DisparityImage scene = wall(0.8);
  StructureSensor a(kCamera, {}, 5);
  StructureSensor b(kCamera, {}, 5);
  StructureSensor other(kCamera, {}, 6);
  const auto first = measure(a, scene, 0);
  const auto second = measure(a, scene, 1);
  EXPECT_EQ(measure(b, scene, 1), second);
  EXPECT_EQ(measure(b, scene, 0), first);
  EXPECT_NE(first, second);
  EXPECT_NE(measure(other, scene, 0), first);
}

TEST(StructureSensor, NothingNearOrFarBeyondRangeIsRead) {
  StructureSensor sensor(kCamera, {}, 1);
  for (const double z : {0.15, 0.25, 9.0, 40.0}) {
    const auto depth = measure(sensor, wall(z), 0);
    EXPECT_TRUE(std::all_of(depth.begin(), depth.end(), [](std::uint16_t d) { return d == 0; })) << z;
  }
  const DisparityImage nothing(kCamera);
  const auto depth = measure(sensor, nothing, 0);
  EXPECT_TRUE(std::all_of(depth.begin(), depth.end(), [](std::uint16_t d) { return d == 0; }));
}

TEST(StructureSensor, GrazingSurfacesLoseReadings) {
  const auto lost = [](double degrees) {
    DisparityImage image(kCamera);
    const double radians = degrees * 3.14159265 / 180;
    image.draw_plane(
        Vector3(0, std::sin(radians), std::cos(radians)), 0.65 * std::cos(radians),
        [](const Vector3& p, const void*) { return p.z() > 0.55 && p.z() < 0.8; }, nullptr);
    StructureSensor sensor(kCamera, {}, 1);
    const auto depth = measure(sensor, image, 0);
    double drawn = 0;
    double read = 0;
    for (std::size_t v = 12; v < 468; ++v)
      for (std::size_t u = 10; u < 620; ++u) {
        if (image.pixels()[(v - 8) * 640 + u] == 0 || image.pixels()[(v + 8) * 640 + u] == 0) continue;
        drawn += 1;
        read += depth[v * 640 + u] > 0 ? 1 : 0;
      }
    EXPECT_GT(drawn, 500);
    return 1 - read / drawn;
  };
  EXPECT_LT(lost(50), 0.01);
  EXPECT_GT(lost(75), 0.015);
  EXPECT_GT(lost(79), lost(72));
}

}  // namespace
}  // namespace pliant::simulated

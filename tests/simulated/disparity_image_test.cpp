#include "drivers/simulated/disparity_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace pliant::simulated {
namespace {

const Intrinsics kCamera{64, 48, 57, 57, 32, 24, 1000};
constexpr double kUnit = static_cast<double>(1 << kDisparityBits);

Vector3 at(double u, double v, double z) {
  return {(u - kCamera.cx) / kCamera.fx * z, (v - kCamera.cy) / kCamera.fy * z, z};
}

TEST(DisparityImage, TrianglesThatShareEdgesLeaveNoGapAndHoldThePlane) {
  // A fan over the whole image, a slanted plane: 1/z affine in u and v.
  const auto depth = [](double u, double v) { return 1 / (1.2 + 0.004 * u - 0.003 * v); };
  std::vector<Vector3> vertices{at(20.3, 17.7, depth(20.3, 17.7))};
  const double rim[][2] = {{-5, -5}, {30.5, -7}, {70, -3}, {66, 20},
                           {70, 55}, {40, 52},   {-6, 50}, {-4, 21.5}};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& p : rim) vertices.push_back(at(p[0], p[1], depth(p[0], p[1])));
  for (std::uint32_t i = 0; i < 8; ++i) triangles.push_back({0, (i + 1) % 8 + 1, i + 1});
  DisparityImage image(kCamera);
  std::vector<std::uint8_t> facing(vertices.size(), 0);
  image.draw(vertices, triangles, facing);
  EXPECT_EQ(std::count(facing.begin(), facing.end(), 1), 9);
  std::size_t i = 0;
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      const double expected = kFocalBaseline / depth(u, v);
      const double drawn = image.pixels()[i++] / kUnit;
      ASSERT_NEAR(drawn, expected, 1e-3) << u << "," << v;
    }
}

TEST(DisparityImage, TheNearerSurfaceWinsInAnyOrder) {
  const std::vector<Vector3> vertices{at(-9, -9, 1.0), at(-9, 99, 1.0), at(99, -9, 1.0),
                                      at(-9, -9, 0.6), at(-9, 99, 0.6), at(99, -9, 0.6)};
  const std::vector<std::array<std::uint32_t, 3>> far_first{{0, 1, 2}, {3, 4, 5}};
  const std::vector<std::array<std::uint32_t, 3>> near_first{{3, 4, 5}, {0, 1, 2}};
  DisparityImage a(kCamera);
  DisparityImage b(kCamera);
  a.draw(vertices, far_first, {});
  b.draw(vertices, near_first, {});
  EXPECT_TRUE(std::equal(a.pixels().begin(), a.pixels().end(), b.pixels().begin()));
  EXPECT_NEAR(a.pixels()[0] / kUnit, kFocalBaseline / 0.6, 1e-3);
  EXPECT_TRUE(a.sees(at(3, 3, 0.6), 0.002));
  EXPECT_FALSE(a.sees(at(3, 3, 1.0), 0.002));
  EXPECT_FALSE(a.sees(at(-3, 3, 0.6), 0.002));
}

TEST(DisparityImage, BackFacesAndWhatIsTooNearAreNotDrawn) {
  DisparityImage image(kCamera);
  const std::vector<Vector3> vertices{at(-9, -9, 1.0), at(-9, 99, 1.0), at(99, -9, 1.0), at(20, 20, 0.05),
                                      Vector3(0, 0, -1)};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 2, 1}, {0, 1, 3}, {0, 1, 4}};
  image.draw(vertices, triangles, {});
  EXPECT_TRUE(
      std::all_of(image.pixels().begin(), image.pixels().end(), [](std::int32_t p) { return p == 0; }));
}

TEST(DisparityImage, SliversAndFarAwayTrianglesAreHarmless) {
  DisparityImage image(kCamera);
  const std::vector<Vector3> vertices{at(10, 10, 1.0),  at(30, 30, 1.0),      at(20.00000001, 20, 1.1),
                                      at(20, 20, 0.11), at(1e9, -1e9, 0.2),   at(-1e9, -1e9, 0.3),
                                      at(0, 1e9, 5.0),  at(15.5, 10.5, 1e12), at(40, 1e-300, 0.5)};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t a = 0; a < 9; ++a)
    for (std::uint32_t b = 0; b < 9; ++b)
      for (std::uint32_t c = 0; c < 9; ++c) triangles.push_back({a, b, c});
  image.draw(vertices, triangles, {});
  for (const std::int32_t p : image.pixels()) EXPECT_LE(p / kUnit, kFocalBaseline / 0.1 + 1);
}

}  // namespace
}  // namespace pliant::simulated

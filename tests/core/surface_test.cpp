#include "core/camera/surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/memory/row_major.hpp"
#include "tests/core/observed_surface.hpp"

namespace pliant {
namespace {

using synthetic::degrees;
using synthetic::Observed;
using synthetic::Picture;

TEST(Surface, RemovesFlyingPixelsAndKeepsEdges) {
  Picture picture(synthetic::small_camera());
  picture.wall(1.2);
  picture.block(100, 80, 200, 160, 0.8);
  picture.block(100, 79, 200, 80, 1.0);  // a line of readings between the two depths
  picture.block(50, 50, 51, 51, 0.7);    // a speck
  picture.block(60, 50, 61, 51, 0);      // a hole
  Observed o;
  o.build(picture);
  EXPECT_EQ(o.surface.depth(50, 50), 0);
  EXPECT_EQ(o.surface.depth(60, 50), 0);
  for (int u = 101; u < 199; ++u) EXPECT_EQ(o.surface.depth(u, 79), 0) << u;
  for (int v = 80; v < 160; ++v)
    for (int u = 100; u < 200; ++u) ASSERT_EQ(o.surface.depth(u, v), 6400) << u << " " << v;
  EXPECT_EQ(o.surface.depth(99, 100), 9600);  // not mixed across the edge
  EXPECT_EQ(o.surface.depth(200, 100), 9600);
  Normal16 n;
  ASSERT_TRUE(o.surface.normal(100, 120, 4, n));  // one-sided at the edge
  EXPECT_LT(degrees(n, {0, 0, -1}), 1.0);
}

TEST(Surface, LeavesReadingsAsTheyAreWithoutTheFilter) {
  Picture picture(synthetic::small_camera());
  picture.wall(1.2);
  picture.block(50, 50, 51, 51, 0.7);  // a speck
  Observed o;
  o.surface.start(synthetic::small_camera(), {}, Kernels::automatic, false);
  o.build(picture);
  EXPECT_EQ(o.surface.depth(50, 50), 5600);
  EXPECT_EQ(o.surface.depth(51, 50), 9600);
}

TEST(Surface, LowersNoiseByAThird) {
  Picture picture(synthetic::small_camera());
  picture.wall(0.8);
  picture.shake(0.0015, 5);
  Observed o;
  o.build(picture);
  double square = 0;
  int count = 0;
  for (int v = 2; v < 238; ++v)
    for (int u = 2; u < 318; ++u) {
      const double off = o.surface.depth(u, v) / kDepthUnitsPerMetre - 0.8;
      square += off * off;
      ++count;
    }
  EXPECT_LT(std::sqrt(square / count), 0.0015 / 2.5);
}

TEST(Surface, AllZeroGivesNothing) {
  Picture picture(synthetic::small_camera());
  Observed o;
  o.build(picture);
  Normal16 n;
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u) {
      ASSERT_EQ(o.surface.depth(u, v), 0);
      ASSERT_FALSE(o.surface.normal(u, v, 8, n));
      ASSERT_TRUE(o.surface.faces(u, v, 8, {0, 0, -16384}));
    }
}

TEST(Surface, OnlyTheWindowHoldsData) {
  Picture picture(synthetic::small_camera());
  picture.wall(1.0);
  Observed o;
  const DepthFrame frame = picture.frame();
  for (const Window& w :
       {Window{0, 0, 320, 240}, Window{17, 33, 121, 90}, Window{100, 60, 101, 61}, Window{-50, -20, 5, 7},
        Window{301, 200, 900, 900}, Window{5, 5, 5, 9}, Window{400, 10, 500, 20}, Window{30, 0, 33, 240}}) {
    o.surface.build(frame, w);
    for (int v = -3; v < 243; ++v)
      for (int u = -3; u < 323; ++u)
        ASSERT_EQ(o.surface.depth(u, v) != 0, w.contains(u, v) && u >= 0 && v >= 0 && u < 320 && v < 240)
            << u << " " << v << " in " << w.u0 << " " << w.v0;
  }
}

TEST(Surface, APixelDoesNotDependOnTheWindow) {
  Picture picture(synthetic::small_camera());
  picture.draw(synthetic::bumpy_body(), synthetic::pose_at({0, 0, 0.7}, {1, 2, 3}, 0.7));
  picture.shake(0.004, 9);
  const DepthFrame frame = picture.frame();
  Observed whole, part;
  whole.surface.build(frame, {0, 0, 320, 240});
  std::mt19937 random(4);
  for (int round = 0; round < 40; ++round) {
    const int u0 = static_cast<int>(random() % 300), v0 = static_cast<int>(random() % 220);
    const Window w{u0, v0, u0 + 1 + static_cast<int>(random() % 120),
                   v0 + 1 + static_cast<int>(random() % 90)};
    part.surface.build(frame, w);
    for (int v = w.v0; v < std::min(w.v1, 240); ++v)
      for (int u = w.u0; u < std::min(w.u1, 320); ++u)
        ASSERT_EQ(part.surface.depth(u, v), whole.surface.depth(u, v)) << u << " " << v;
  }
}

TEST(Surface, EveryBodyAndStrideGivesTheSamePicture) {
  // random and extreme readings, odd sizes, rows apart
  std::mt19937 random(6);
  for (const auto& [width, height] : {std::pair{320, 240}, std::pair{33, 25}, std::pair{47, 31}}) {
    Intrinsics camera = synthetic::small_camera();
    camera.width = width;
    camera.height = height;
    Observed scalar(camera, Kernels::scalar), sse(camera, Kernels::sse), avx2(camera, Kernels::avx2),
        neon(camera, Kernels::neon);
    const int stride = width + 5;
    std::vector<std::uint16_t> raw(row_major(height - 1, stride, width));
    for (int round = 0; round < 6; ++round) {
      for (std::uint16_t& x : raw)
        x = static_cast<std::uint16_t>(round % 2 == 0      ? random()
                                       : random() % 4 == 0 ? 0
                                                           : 900 + random() % 30);
      const DepthFrame frame{raw.data(), width, height, stride, 0, 0};
      for (Observed* o : {&scalar, &sse, &avx2, &neon})
        o->surface.build(frame, {round, round, width, height - round});
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u)
          for (Observed* o : {&sse, &avx2, &neon})
            ASSERT_EQ(o->surface.depth(u, v), scalar.surface.depth(u, v)) << u << " " << v;
    }
  }
}

TEST(Surface, SigmaFollowsTheSensor) {
  Observed o;
  const SensorDescription sensor;
  for (int z = 4800; z < 128000; z += 500)
    EXPECT_NEAR(o.surface.sigma(z) / kUnitsPerMetre, sensor.sigma(z / kUnitsPerMetre), 0.0006) << z;
  EXPECT_GE(o.surface.sigma(-5), 1);
  EXPECT_GE(o.surface.sigma(1 << 30), 1);
}

}  // namespace
}  // namespace pliant

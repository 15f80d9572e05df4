#include "core/camera/surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/memory/row_major.hpp"
#include "tests/core/synthetic.hpp"

namespace pliant {
namespace {

using synthetic::OwnedWorkspace;
using synthetic::Picture;

/// A started surface with memory of its own.
struct Observed {
  explicit Observed(const Intrinsics& camera = synthetic::small_camera(),
                    Kernels kernels = Kernels::automatic, const SensorDescription& sensor = {})
      : memory(needed(camera)) {
    surface.lay_out(memory.get(), camera);
    surface.start(camera, sensor, kernels);
  }
  static std::size_t needed(const Intrinsics& camera) {
    Workspace measure;
    Surface surface;
    surface.lay_out(measure, camera);
    return measure.used();
  }
  void build(Picture& picture) { surface.build(picture.frame(), {0, 0, surface.width(), surface.height()}); }

  OwnedWorkspace memory;
  Surface surface;
};

Vector3 ray(const Intrinsics& c, int u, int v) {
  return {(u - c.cx) / c.fx, (v - c.cy) / c.fy, 1};
}

Vector3 metres(const IntPoint& p) {
  return Vector3(p.x, p.y, p.z) / kUnitsPerMetre;
}

double degrees(const Normal16& n, const Vector3& truth) {
  const Vector3 m = Vector3(n.x, n.y, n.z).normalized();
  return std::acos(std::clamp(m.dot(truth.normalized()), -1.0, 1.0)) * 180 / 3.14159265;
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
  const Window window{150, 110, 170, 130};
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

TEST(Surface, ExtremeReadingsAndCamerasStayInBounds) {
  // what the sanitizers watch: wild depth under the widest and the longest lens that is let in
  std::mt19937 random(8);
  for (const double focal : {10.0, 100.0, 10000.0}) {
    const Intrinsics camera{64, 48, focal, focal, focal > 1000 ? 8000.0 : -4000.0, 24, 8000};
    ASSERT_EQ(intrinsics_fault(camera), nullptr);
    Observed o(camera, Kernels::automatic, {0.05, 0.1, 0.05, 8.0});
    std::vector<std::uint16_t> raw(64 * 48);
    for (std::uint16_t& x : raw)
      x = static_cast<std::uint16_t>(random() % 2 == 0 ? 64000 - random() % 9000 : random());
    o.surface.build({raw.data(), 64, 48, 64, 0, 0}, {0, 0, 64, 48});
    for (int v = 0; v < 48; ++v)
      for (int u = 0; u < 64; ++u)
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
  EXPECT_EQ(o.surface.normal_step(0, 0.005), 1);
  EXPECT_EQ(o.surface.normal_step(8000, 0.0), 1);
  EXPECT_EQ(o.surface.normal_step(8000, 0.010), 3);  // 290 px · 1 cm at 1 m
  EXPECT_EQ(o.surface.normal_step(4000, 0.010), 6);
  EXPECT_EQ(o.surface.normal_step(1, 5.0), Surface::kMostStep);
  EXPECT_EQ(o.surface.normal_step(65535, 1e9), Surface::kMostStep);
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

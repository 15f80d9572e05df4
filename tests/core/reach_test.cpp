// A sensor as noisy as may be makes the lengths that decisions rest on longer than the integers are for: none
// reaches beyond kFarthestReading.
#include <gtest/gtest.h>

#include "core/deform/patch_readings.hpp"
#include "core/track/aside.hpp"
#include "core/track/sight.hpp"
#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;

class Reach : public synthetic::SharedScene<synthetic::bumpy_body> {
 protected:
  void SetUp() override {
    scene().surface.start(scene().camera, {0.05, 0.1, 0.05, 8.0});
    scene().points.reset();
  }
  static void see_wall(double depth) {
    Picture picture(scene().camera);
    picture.wall(depth);
    scene().see(picture);
  }
};

TEST_F(Reach, TheInlierLimitIsBounded) {
  EXPECT_EQ(scene().tolerance.deformed(16000), 4 * scene().surface.sigma(16000));
  EXPECT_EQ(scene().tolerance.deformed(128000), kFarthestReading);
  EXPECT_EQ((Tolerance{&scene().surface, 100000}.deformed(16000)), kFarthestReading);
}

TEST_F(Reach, NoReadingFartherInDepthAgrees) {
  // 55 degrees from the line of sight: along the normal the wall lies nearer than the limit of 456 mm
  const IntPoint point{0, 0, 19200}, normal{13421, 0, -9397};
  const Sighting sighting(scene().tables, scene().surface, scene().projector, scene().tolerance);
  see_wall(1.6);
  EXPECT_EQ(sighting.look(point, normal).sight, Sight::agrees);
  see_wall(1.8);
  const Sighting::Look look = sighting.look(point, normal);
  EXPECT_EQ(look.sight, Sight::in_front);
  EXPECT_EQ(look.residual, -kFarthestReading);
}

TEST_F(Reach, NothingFartherAsidePulls) {
  const int u = 40, step = 25, v = 120;
  Picture picture(scene().camera);
  picture.block(u + step, 0, scene().camera.width, scene().camera.height, 7.99);
  scene().see(picture);
  const std::uint16_t z8 = scene().surface.depth(u + step, v);
  ASSERT_NE(z8, 0);
  const IntPoint q = scene().surface.vertex(u + step, v, z8);
  // 65536 squared leaves nothing in 32 bits
  for (const std::int32_t off : {1600, 8190, 8191, 20000, 65536, 65537}) {
    const IntPoint at{q.x - off, q.y, q.z};
    Aside found;
    const bool any = find_aside(scene().surface, {70000, 70000, step, {}}, u, v, at, {0, 0, -16384}, found);
    EXPECT_EQ(any, off < kFarthestReading) << off;
    if (any) {
      EXPECT_EQ(found.distance, off);
    }
  }
}

TEST_F(Reach, LooksBesideNoFartherWhateverIsAsked) {
  Picture picture(scene().camera);
  picture.block(164, 0, scene().camera.width, scene().camera.height, 2.0);
  scene().see(picture);
  const Sighting sighting(scene().tables, scene().surface, scene().projector, scene().tolerance);
  const IntPoint point{0, 0, 32000}, normal{0, 0, -16384};
  for (const std::int32_t reach : {8191, 16382, 100000}) {
    Sighting::Look look = sighting.look(point, normal);
    ASSERT_TRUE(look.facing);
    ASSERT_EQ(look.sight, Sight::none);
    ASSERT_TRUE(sighting.look_beside(reach, look)) << reach;
    EXPECT_LE(look.residual, kFarthestReading);
    Sighting::Look bounded = sighting.look(point, normal);
    ASSERT_TRUE(sighting.look_beside(kFarthestReading, bounded));
    EXPECT_EQ(look.match, bounded.match) << reach;
  }
}

TEST_F(Reach, ThePatchesGatesNarrowToNoMore) {
  ReadingGates gates{8000, 400, {}};
  gates.narrow(2 * scene().tolerance.deformed(128000));
  EXPECT_EQ(gates.inward, kFarthestReading);
  EXPECT_EQ(gates.outward, kFarthestReading);
  gates = {8000, 400, {}};
  gates.narrow(350);
  EXPECT_EQ(gates.inward, 6000);
  EXPECT_EQ(gates.outward, 350);
}

}  // namespace
}  // namespace pliant

#include "core/track/strays.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

/// A bar whose right half is region 1.
class Strays : public synthetic::SharedScene<synthetic::two_part_bar, 5> {
 protected:
  void SetUp() override {
    scene().points.reset();
    for (std::size_t p = 0; p < scene().patches.count; ++p)
      scene().warp->home[p] = scene().patches.centres[p].x() > 0 ? std::int8_t{1} : std::int8_t{0};
    for (std::size_t i = 0; i < scene().tables.size; ++i)
      scene().points.home[i] = scene().warp->home[scene().patches.patch_of[i]];
  }
  static std::size_t point_at(double x) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < scene().tables.size; ++i)
      if (std::abs(scene().rest(i).x() - x) < std::abs(scene().rest(nearest).x() - x)) nearest = i;
    return nearest;
  }
  static void recall() { recall_strays(scene().patches, *scene().warp, scene().points); }
};

TEST_F(Strays, GoOverToTheRegionThatTheyLieIn) {
  const std::size_t left = point_at(-0.12), right = point_at(0.12);
  scene().points.home[left] = 1;
  scene().points.evidence[left] = kEvidenceMax;
  scene().points.rival[left] = 0;
  scene().points.switching[left] = 5;
  scene().points.home[right] = 5;  // a region that has no patch any more
  recall();
  EXPECT_EQ(scene().points.home[left], 0);
  EXPECT_EQ(scene().points.evidence[left], 0);
  EXPECT_EQ(scene().points.rival[left], -1);
  EXPECT_EQ(scene().points.switching[left], 0);
  EXPECT_EQ(scene().points.home[right], 1);
}

TEST_F(Strays, AreNoneWhereRegionsMeet) {
  const std::size_t border = point_at(0.001), other = point_at(-0.001);
  scene().points.home[border] = 0;
  scene().points.home[other] = 1;
  recall();
  EXPECT_EQ(scene().points.home[border], 0);
  EXPECT_EQ(scene().points.home[other], 1);
}

}  // namespace
}  // namespace pliant

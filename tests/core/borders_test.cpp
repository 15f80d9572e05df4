#include "core/track/borders.hpp"

#include <gtest/gtest.h>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::TrackScene;

class Borders : public ::testing::Test {
 protected:
  [[nodiscard]] std::size_t count() const {
    const RegionBorders borders = region_borders(scene_.patches, scene_.points.home);
    std::size_t count = 0;
    for (std::size_t p = 0; p < scene_.patches.count; ++p) count += borders.has(p) ? 1U : 0U;
    return count;
  }
  TrackScene scene_{synthetic::two_part_bar(), 0.006};
};

TEST_F(Borders, OneRegionHasNone) {
  EXPECT_EQ(count(), 0U);
}

TEST_F(Borders, AreThePatchesWhereRegionsMeetAndTheirNeighbours) {
  for (std::size_t i = 0; i < scene_.tables.size; ++i)
    scene_.points.home[i] = scene_.rest(i).x() > 0 ? std::int8_t{1} : std::int8_t{0};
  const RegionBorders borders = region_borders(scene_.patches, scene_.points.home);
  EXPECT_GT(count(), 3U);
  EXPECT_LT(count(), scene_.patches.count);
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    const std::size_t p = scene_.patches.patch_of[i];
    for (const std::uint16_t n : scene_.model.neighbours(i))
      if (n < scene_.tables.size && scene_.points.home[n] != scene_.points.home[i]) {
        ASSERT_TRUE(borders.has(p) && borders.has(scene_.patches.patch_of[n])) << i;
      }
    if (std::abs(scene_.rest(i).x()) > 5 * scene_.patches.radius) {
      ASSERT_FALSE(borders.has(p)) << i;
    }
  }
}

TEST_F(Borders, OnePointOfAnotherRegionMakesItsPatchABorder) {
  scene_.points.home[7] = 3;
  const RegionBorders borders = region_borders(scene_.patches, scene_.points.home);
  EXPECT_TRUE(borders.has(scene_.patches.patch_of[7]));
  EXPECT_GT(count(), 1U);
}

TEST_F(Borders, KnowWhichRegionsMeet) {
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    const double x = scene_.rest(i).x();
    scene_.points.home[i] = x > 5 * scene_.patches.radius    ? std::int8_t{2}
                            : x < -5 * scene_.patches.radius ? std::int8_t{5}
                                                             : std::int8_t{0};
  }
  const RegionBorders borders = region_borders(scene_.patches, scene_.points.home);
  bool with2 = false, with5 = false;
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    const std::size_t p = scene_.patches.patch_of[i];
    ASSERT_TRUE(borders.meets(p, static_cast<std::size_t>(scene_.points.home[i])));
    ASSERT_FALSE(borders.meets(p, 1));
    ASSERT_FALSE(borders.meets(p, 2) && borders.meets(p, 5)) << "they do not meet";
    with2 = with2 || (scene_.points.home[i] == 0 && borders.meets(p, 2));
    with5 = with5 || (scene_.points.home[i] == 0 && borders.meets(p, 5));
  }
  EXPECT_TRUE(with2 && with5);
}

}  // namespace
}  // namespace pliant

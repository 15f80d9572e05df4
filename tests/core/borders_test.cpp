#include "core/track/borders.hpp"

#include <gtest/gtest.h>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::TrackScene;

class Borders : public ::testing::Test {
 protected:
  [[nodiscard]] std::size_t count() const {
    const PatchSet set = border_patches(scene_.patches, scene_.points.home);
    std::size_t count = 0;
    for (std::size_t p = 0; p < scene_.patches.count; ++p) count += set.has(p) ? 1U : 0U;
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
  const PatchSet set = border_patches(scene_.patches, scene_.points.home);
  EXPECT_GT(count(), 3U);
  EXPECT_LT(count(), scene_.patches.count);
  for (std::size_t i = 0; i < scene_.tables.size; ++i) {
    const std::size_t p = scene_.patches.patch_of[i];
    for (const std::uint16_t n : scene_.model.neighbours(i))
      if (n < scene_.tables.size && scene_.points.home[n] != scene_.points.home[i]) {
        ASSERT_TRUE(set.has(p) && set.has(scene_.patches.patch_of[n])) << i;
      }
    if (std::abs(scene_.rest(i).x()) > 5 * scene_.patches.radius) {
      ASSERT_FALSE(set.has(p)) << i;
    }
  }
}

TEST_F(Borders, OnePointOfAnotherRegionMakesItsPatchABorder) {
  scene_.points.home[7] = 3;
  const PatchSet set = border_patches(scene_.patches, scene_.points.home);
  EXPECT_TRUE(set.has(scene_.patches.patch_of[7]));
  EXPECT_GT(count(), 1U);
}

}  // namespace
}  // namespace pliant

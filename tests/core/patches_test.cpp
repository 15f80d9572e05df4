#include "core/track/patches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

TEST(Patches, CoverTheSurfaceInEvenConnectedPieces) {
  synthetic::TrackScene scene(synthetic::bumpy_body());
  const PatchTables& patches = scene.patches;
  ASSERT_EQ(patches.count, std::min(kMaxPatches, scene.tables.size / 24));
  std::vector<std::size_t> members(patches.count, 0);
  for (std::size_t i = 0; i < scene.tables.size; ++i) {
    ASSERT_LT(patches.patch_of[i], patches.count);
    ++members[patches.patch_of[i]];
  }
  const std::size_t mean = scene.tables.size / patches.count;
  for (std::size_t p = 0; p < patches.count; ++p) {
    EXPECT_GT(members[p], mean / 4);
    EXPECT_LT(members[p], mean * 3);
    EXPECT_EQ(patches.patch_of[p], p);  // its seed is its own
  }
  // From every point a way along the graph leads to the seed within the patch.
  std::vector<bool> reached(scene.tables.size, false);
  std::vector<std::size_t> stack;
  for (std::size_t p = 0; p < patches.count; ++p) {
    stack.push_back(p);
    reached[p] = true;
  }
  while (!stack.empty()) {
    const std::size_t i = stack.back();
    stack.pop_back();
    for (const std::uint16_t n : scene.model.neighbours(i)) {
      if (n == kNoNeighbour || reached[n] || patches.patch_of[n] != patches.patch_of[i]) continue;
      reached[n] = true;
      stack.push_back(n);
    }
  }
  EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 0);
}

TEST(Patches, AreNeighboursBothWays) {
  synthetic::TrackScene scene(synthetic::bumpy_body());
  for (std::size_t p = 0; p < scene.patches.count; ++p) {
    std::size_t neighbours = 0;
    EXPECT_FALSE(scene.patches.neighbours[p].has(p));
    for (std::size_t q = 0; q < scene.patches.count; ++q) {
      EXPECT_EQ(scene.patches.neighbours[p].has(q), scene.patches.neighbours[q].has(p));
      neighbours += scene.patches.neighbours[p].has(q) ? 1U : 0U;
    }
    EXPECT_GE(neighbours, 3U);
    EXPECT_LE(neighbours, 14U);
  }
}

TEST(PatchSet, HoldsEveryPatch) {
  PatchSet set;
  for (std::size_t p = 0; p < kMaxPatches; p += 5) set.add(p);
  for (std::size_t p = 0; p < kMaxPatches; ++p) EXPECT_EQ(set.has(p), p % 5 == 0);
  PatchSet other = set;
  EXPECT_EQ(set, other);
  other.add(1);
  EXPECT_FALSE(set == other);
}

}  // namespace
}  // namespace pliant

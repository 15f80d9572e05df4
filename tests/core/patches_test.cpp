#include "core/track/patches.hpp"

#include <gtest/gtest.h>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

TEST(Patches, AreThoseOfTheModel) {
  synthetic::TrackScene scene(synthetic::bumpy_body());
  const PatchTables& patches = scene.patches;
  const ModelView& model = scene.model;
  ASSERT_EQ(patches.count, model.patches().size());
  EXPECT_EQ(patches.radius, model.patch_radius());
  for (std::size_t p = 0; p < patches.count; ++p) {
    EXPECT_EQ(patches.sizes[p], model.patches()[p].points);
    EXPECT_EQ(patches.centres[p], to_vector(model.patches()[p].centre));
  }
  ASSERT_EQ(patches.border_count, model.surface_links().size());
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    const SurfaceLink& link = model.surface_links()[k];
    EXPECT_EQ(border.a, link.a);
    EXPECT_EQ(border.b, link.b);
    EXPECT_EQ(border.edges, link.edges);
    EXPECT_EQ(border.length, link.length);
    EXPECT_EQ(border.centre, to_vector(link.centre));
  }
  ASSERT_EQ(patches.tie_count, model.body_links().size());
  EXPECT_GT(patches.tie_count, 0U);
  for (std::size_t k = 0; k < patches.tie_count; ++k) {
    const PatchTie& tie = patches.ties[k];
    const BodyLink& link = model.body_links()[k];
    EXPECT_EQ(tie.a, link.a);
    EXPECT_EQ(tie.b, link.b);
    EXPECT_EQ(tie.looks, link.looks);
    EXPECT_EQ(tie.length, link.length);
    EXPECT_EQ(tie.middle, to_vector(link.middle));
  }
  EXPECT_EQ(patches.patch_of.data(), model.patch_of().data());
  EXPECT_EQ(patches.blend.data(), model.blends().data());
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

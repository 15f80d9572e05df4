// A chain of regions does not tear the object apart.
#include "tests/accuracy/torn_scenes.hpp"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(MechanicalConstraints, KeepJointsTogether) {
  const std::filesystem::path file = PLIANT_SHARED_DATA "/cases/c_humanoid/model.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared data";
  const BuiltFromFile model(file);
  ASSERT_TRUE(model.good);
  int without = 0, with = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const std::vector<Point3f> scene = torn_scene(model.view, static_cast<TornKind>(seed % 3), seed);
    without += register_torn(model.view, scene, false).regions;
    const TornResult held = register_torn(model.view, scene, true);
    EXPECT_TRUE(held.found) << seed;
    EXPECT_LE(held.worst_tear, 0.010) << seed;
    with += held.regions;
  }
  EXPECT_GE(without, 3);
  EXPECT_LE(5 * with, without);
}

}  // namespace
}  // namespace pliant

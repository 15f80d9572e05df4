// Files of the field as they are found in the wild.
#include <filesystem>

#include "tests/geometry_files/bytes.hpp"

namespace pliant {
namespace {

using namespace testing;

struct Known {
  const char* path;
  std::size_t vertices, triangles;
  bool normals;
};

class SharedData : public ::testing::TestWithParam<Known> {};

TEST_P(SharedData, IsReadWhole) {
  const std::filesystem::path path = std::filesystem::path(PLIANT_SHARED_DATA) / GetParam().path;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data at " << path;
  const Result<Geometry> g = read_geometry(path);
  ASSERT_TRUE(g) << g.error().message;
  EXPECT_EQ(g->vertices.size() + g->dropped, GetParam().vertices);
  EXPECT_EQ(g->triangles.size(), GetParam().triangles);
  EXPECT_EQ(!g->normals.empty(), GetParam().normals);
}

INSTANTIATE_TEST_SUITE_P(Files, SharedData,
                         ::testing::Values(Known{"real_plush_squirrel/model.ply", 4200, 7800, true},
                                           Known{"real_dragon_cube_realsense/model_cube.ply", 8, 12, true},
                                           Known{"cases/a_misaligned/scene.ply", 11798, 0, false},
                                           Known{"real_milk_clutter/milk.pcd", 12575, 0, false},
                                           Known{"real_milk_clutter/milk_cartoon_all_small_clorox.pcd",
                                                 307200, 0, false},
                                           Known{"seq_cylinder_lbs/rest.obj", 420, 800, false}));

}  // namespace
}  // namespace pliant

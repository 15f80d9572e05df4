// Objects of the real and simulated recordings.
#include <filesystem>

#include "tests/model_files/built.hpp"

namespace pliant {
namespace {

using namespace testing;

struct Known {
  const char* path;
  bool characterisable;
  std::size_t least_points;
};

class SharedModel : public ::testing::TestWithParam<Known> {};

TEST_P(SharedModel, IsBuiltWhole) {
  const std::filesystem::path path = std::filesystem::path(PLIANT_SHARED_DATA) / GetParam().path;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data at " << path;
  const Result<Geometry> g = read_geometry(path);
  ASSERT_TRUE(g) << g.error().message;
  const Made made = make(*g);
  EXPECT_EQ(made.built.characterisable, GetParam().characterisable) << made.built.reason;
  EXPECT_GE(made.view().size(), GetParam().least_points);
  EXPECT_LE(made.view().size(), limits::kMaxModelPoints);
  if (g->normals.empty()) return;
  // The files' normals point outward. Their vertices are kept, in another order.
  std::size_t agree = 0, compared = 0;
  for (std::size_t i = 0; i < made.view().size(); i += 11) {
    const Point3f& p = made.view().positions()[i];
    for (std::size_t k = 0; k < g->vertices.size(); ++k) {
      const Point3f& v = g->vertices[k];
      if (v.x != p.x || v.y != p.y || v.z != p.z) continue;
      ++compared;
      agree += to_vector(g->normals[k]).dot(to_vector(made.view().normals()[i])) > 0 ? 1U : 0U;
      break;
    }
  }
  EXPECT_GE(static_cast<double>(agree), 0.99 * static_cast<double>(compared));
}

INSTANTIATE_TEST_SUITE_P(Objects, SharedModel,
                         ::testing::Values(Known{"real_plush_squirrel/model.ply", true, 3500},
                                           Known{"sim_bunny_press/model.ply", true, 6000},
                                           Known{"sim_homer_joints/model.ply", true, 5900},
                                           Known{"sim_cushion_occlusion/model.ply", true, 6000},
                                           Known{"cases/a_misaligned/model.ply", true, 11798},
                                           Known{"real_dragon_cube_realsense/model_cube.ply", true, 6000},
                                           Known{"real_milk_clutter/milk.pcd", true, 12000},
                                           Known{"seq_cylinder_lbs/rest.obj", false, 6000}));

}  // namespace
}  // namespace pliant

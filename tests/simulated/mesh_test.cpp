// The meshes of the objects: closed, even, of the right size, facing outward.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "drivers/simulated/actor.hpp"

namespace pliant::simulated {
namespace {

void check(const Geometry& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  double volume = 0;
  std::size_t against = 0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    const Vector3 a = to_vector(mesh.vertices[t[0]]);
    const Vector3 b = to_vector(mesh.vertices[t[1]]);
    const Vector3 c = to_vector(mesh.vertices[t[2]]);
    volume += a.dot(b.cross(c)) / 6;
    against += (b - a).cross(c - a).dot(to_vector(mesh.normals[t[0]])) < 0 ? 1U : 0U;
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  EXPECT_GT(volume, 0);
  EXPECT_LT(against, mesh.triangles.size() / 200);  // at sharp edges a vertex normal may lean over
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << "an open edge";
  }
  for (const Point3f& n : mesh.normals) ASSERT_NEAR(to_vector(n).norm(), 1, 1e-5);
}

double mean_side(const Geometry& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      sum += (to_vector(mesh.vertices[t[i]]) - to_vector(mesh.vertices[t[(i + 1) % 3]])).norm();
  return sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

double largest_extent(const Geometry& mesh) {
  Vector3 low = Vector3::Constant(1e9);
  Vector3 high = -low;
  for (const Point3f& p : mesh.vertices) {
    low = low.cwiseMin(to_vector(p));
    high = high.cwiseMax(to_vector(p));
  }
  return (high - low).maxCoeff();
}

class ObjectMesh : public testing::TestWithParam<std::unique_ptr<Actor> (*)()> {};

TEST_P(ObjectMesh, IsClosedEvenAndOfHandlingSize) {
  const std::unique_ptr<Actor> actor = GetParam()();
  check(actor->mesh());
  EXPECT_GE(actor->mesh().vertices.size(), 5000U);
  EXPECT_LE(actor->mesh().vertices.size(), 8200U);
  EXPECT_GE(mean_side(actor->mesh()), 0.004);
  EXPECT_LE(mean_side(actor->mesh()), 0.0065);
  EXPECT_GE(largest_extent(actor->mesh()), 0.23);
  EXPECT_LE(largest_extent(actor->mesh()), 0.45);
  EXPECT_EQ(actor->vertex_part().size(), actor->mesh().vertices.size());
  for (const std::int8_t part : actor->vertex_part()) {
    ASSERT_GE(part, -1);
    ASSERT_LT(part, static_cast<int>(actor->parts()));
  }
}

TEST_P(ObjectMesh, HandIsClosed) {
  check(GetParam()()->hand());
}

INSTANTIATE_TEST_SUITE_P(All, ObjectMesh, testing::Values(&make_cushion, &make_figure, &make_box));

}  // namespace
}  // namespace pliant::simulated

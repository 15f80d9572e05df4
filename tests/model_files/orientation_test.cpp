#include "tests/model_files/built.hpp"
#include "tests/model_files/shapes.hpp"

namespace pliant {
namespace {

using namespace testing;

double outward_of_sphere(const Vector3& p, const Vector3& n) {
  return n.dot(p);
}

TEST(Orientation, InvertedMixedAndOpenMeshesFaceOutward) {
  const Geometry sphere = shapes::sphere(0.1, 50);
  const Made good = make(sphere);
  EXPECT_TRUE(good.built.closed_surface);
  EXPECT_EQ(share_outward(good.view(), outward_of_sphere), 1);
  EXPECT_TRUE(good.built.warnings.empty()) << good.built.warnings[0];

  const Made inverted = make(shapes::turned_over(sphere));
  EXPECT_TRUE(inverted.built.closed_surface);
  EXPECT_EQ(share_outward(inverted.view(), outward_of_sphere), 1);
  EXPECT_TRUE(warned(inverted.built, "faces inward"));

  Geometry mixed = sphere;
  for (std::size_t i = 0; i < mixed.triangles.size(); i += 3)
    std::swap(mixed.triangles[i][1], mixed.triangles[i][2]);
  const Made mended = make(mixed);
  EXPECT_EQ(share_outward(mended.view(), outward_of_sphere), 1);
  EXPECT_TRUE(warned(mended.built, "against its neighbours"));

  Geometry open = shapes::turned_over(sphere);
  std::erase_if(open.triangles, [&](const auto& t) { return open.vertices[t[0]].z > 0.05F; });
  const Made bowl = make(open);
  EXPECT_FALSE(bowl.built.closed_surface);
  EXPECT_GT(share_outward(bowl.view(), outward_of_sphere), 0.99);
}

TEST(Orientation, EachPartOfAnObjectByItself) {
  Geometry left = shapes::sphere(0.1, 40), right = shapes::turned_over(shapes::sphere(0.1, 40));
  for (Point3f& p : right.vertices) p.x += 0.3F;
  const Made made = make(shapes::joined(left, right));
  EXPECT_EQ(share_outward(made.view(),
                          [](const Vector3& p, const Vector3& n) {
                            return n.dot(p - Vector3(p.x() > 0.15 ? 0.3 : 0, 0, 0));
                          }),
            1);
}

TEST(Orientation, BothSidesOfAThinPlateKeepTheirOwn) {
  const Made made = make(shapes::thin_plate(0.2, 0.004, 60));
  EXPECT_EQ(
      share_outward(made.view(), [](const Vector3& p, const Vector3& n) { return n.z() * (p.z() - 0.002); }),
      1);
}

}  // namespace
}  // namespace pliant

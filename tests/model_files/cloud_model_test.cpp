#include "tests/model_files/built.hpp"
#include "tests/model_files/shapes.hpp"

namespace pliant {
namespace {

using namespace testing;

double outward_of_sphere(const Vector3& p, const Vector3& n) {
  return n.dot(p);
}

TEST(CloudModel, EstimatesNormalsThatPointOutward) {
  const Made sphere = make(shapes::with_noise(shapes::even_sphere(0.1, 6000), 0.001));
  EXPECT_GT(share_outward(sphere.view(), outward_of_sphere), 0.999);
  // A torus has an inside to fall into.
  const Made torus = make(shapes::cloud_of(shapes::torus(0.1, 0.04, 50)));
  EXPECT_GT(share_outward(torus.view(),
                          [](const Vector3& p, const Vector3& n) {
                            const Vector3 middle = Vector3(p.x(), p.y(), 0).normalized() * 0.1;
                            return n.dot(p - middle);
                          }),
            0.999);
}

TEST(CloudModel, AnOpenPatchIsSeenFromItsHollowOutside) {
  Geometry patch = shapes::patch(60, 60, [](double s, double t) {
    const double x = 0.2 * (s - 0.5), y = 0.2 * (t - 0.5);
    return Vector3(x, y, 0.08 - 4 * (x * x + y * y));
  });
  const Made made = make(shapes::cloud_of(patch));
  EXPECT_GT(share_outward(made.view(), [](const Vector3&, const Vector3& n) { return n.z(); }), 0.999);
}

TEST(CloudModel, KeepsGivenNormalsAndFillsGaps) {
  Geometry sphere = shapes::cloud_of(shapes::sphere(0.1, 60));
  for (const Point3f& p : sphere.vertices) sphere.normals.push_back({3 * p.x, 3 * p.y, 3 * p.z});
  for (std::size_t i = 0; i < sphere.normals.size(); i += 5) sphere.normals[i] = {0, 0, 0};
  const Made made = make(sphere);
  EXPECT_FALSE(warned(made.built, "inward"));
  EXPECT_GT(share_outward(made.view(),
                          [](const Vector3& p, const Vector3& n) { return n.dot(p.normalized()) - 0.99; }),
            0.99);
  for (Point3f& n : sphere.normals) n = {-n.x, -n.y, -n.z};
  const Made turned = make(sphere);
  EXPECT_TRUE(warned(turned.built, "face inward"));
  EXPECT_GT(share_outward(turned.view(), outward_of_sphere), 0.999);
}

TEST(CloudModel, ThinsOutAndSaysThatItCannotMakeDenser) {
  const Geometry cloud = shapes::cloud_of(shapes::sphere(0.1, 120));
  const Made made = make(cloud);
  EXPECT_EQ(made.built.origin, PointOrigin::reduced_vertices);
  EXPECT_GE(made.view().size(), 6000U);
  EXPECT_LE(made.view().size(), 10000U);
  EXPECT_NEAR(make(cloud, {1, 0.008}).built.spacing, 0.008, 0.0012);
  EXPECT_TRUE(
      warned(make(shapes::cloud_of(shapes::sphere(0.1, 20)), {1, 0.001}).built, "cannot be made denser"));
}

}  // namespace
}  // namespace pliant

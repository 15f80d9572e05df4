#include <algorithm>
#include <limits>
#include <set>

#include "tests/model_files/built.hpp"
#include "tests/model_files/shapes.hpp"

namespace pliant {
namespace {

using namespace testing;

/// How far p lies off the surface of a box from 0 to `size`.
double off_box(const Vector3& p, const Vector3& size) {
  const Vector3 outside = (-p).cwiseMax(p - size).cwiseMax(0.0);
  const double inside = std::min(p.minCoeff(), (size - p).minCoeff());
  return outside.isZero() ? std::fabs(inside) : outside.norm();
}

TEST(ModelBuilder, KeepsTheVerticesOfADenseMesh) {
  const Geometry input = shapes::sphere(0.1, 60);
  const Made made = make(input, {1, 0.012});
  std::set<std::array<float, 3>> vertices;
  for (const Point3f& p : input.vertices) vertices.insert({p.x, p.y, p.z});
  for (const Point3f& p : made.view().positions()) EXPECT_TRUE(vertices.contains({p.x, p.y, p.z}));
  EXPECT_NEAR(made.built.spacing, 0.012, 0.002);
  EXPECT_EQ(made.built.origin, PointOrigin::reduced_vertices);

  const Made all = make(shapes::torus(0.1, 0.03, 40));
  EXPECT_EQ(all.built.origin, PointOrigin::input_vertices);
  EXPECT_EQ(all.view().size(), 4800U);  // the seam's doubled vertices are welded
}

TEST(ModelBuilder, SamplesACoarseMeshEvenlyOnItsSurface) {
  const Vector3 size(0.07, 0.09, 0.2);
  const Made made = make(shapes::box(size.x(), size.y(), size.z()));
  EXPECT_EQ(made.built.origin, PointOrigin::sampled_surface);
  EXPECT_GE(made.view().size(), 6000U);
  EXPECT_LE(made.view().size(), 10000U);
  double worst = 0;
  std::size_t on_top = 0;
  for (const Point3f& p : made.view().positions()) {
    worst = std::max(worst, off_box(to_vector(p), size));
    on_top += std::fabs(static_cast<double>(p.z) - size.z()) < 1e-6 ? 1U : 0U;
  }
  EXPECT_LT(worst, 0.0001);
  const double area = 2 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  const double share = size.x() * size.y() / area;
  EXPECT_NEAR(static_cast<double>(on_top) / static_cast<double>(made.view().size()), share, 0.2 * share);
  EXPECT_EQ(
      share_outward(made.view(), [&](const Vector3& p, const Vector3& n) { return n.dot(p - 0.5 * size); }),
      1);
}

TEST(ModelBuilder, KeepsTheSpacingAskedForAndSaysWhenItCannot) {
  for (const double spacing : {0.004, 0.008}) {
    const Made made = make(shapes::box(0.1, 0.1, 0.2), {1, spacing});
    EXPECT_NEAR(made.built.spacing, spacing, 0.15 * spacing);
  }
  const Made made = make(shapes::box(0.1, 0.1, 0.2), {1, 0.0005});
  EXPECT_EQ(made.view().size(), limits::kMaxModelPoints);
  EXPECT_TRUE(warned(made.built, "0.5 mm between points were asked for"));
}

TEST(ModelBuilder, AnyPrefixIsAnEvenSampling) {
  const Made made = make(shapes::sphere(0.1, 60));
  const std::span<const Point3f> points = made.view().positions();
  for (const std::size_t prefix : {100U, 400U, 1600U}) {
    double nearest = 1, farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      double best = 1;
      for (std::size_t j = 0; j < prefix; ++j)
        if (i != j) best = std::min(best, (to_vector(points[i]) - to_vector(points[j])).norm());
      if (i < prefix)
        nearest = std::min(nearest, best);
      else
        farthest = std::max(farthest, best);
    }
    EXPECT_LE(farthest, nearest * (1 + 1e-5)) << prefix;  // no gap is wider than the samples keep apart
  }
}

TEST(ModelBuilder, IsDeterministic) {
  EXPECT_EQ(make(shapes::box(0.1, 0.2, 0.3)).built.image, make(shapes::box(0.1, 0.2, 0.3)).built.image);
  const Geometry cloud = shapes::cloud_of(shapes::torus(0.1, 0.03, 40));
  EXPECT_EQ(make(cloud).built.image, make(cloud).built.image);
}

TEST(ModelBuilder, UnitsScaleAndOddSizesAreQuestioned) {
  const Made metres = make(shapes::box(0.07, 0.09, 0.2));
  EXPECT_FALSE(warned(metres.built, "units"));
  const Made millimetres = make(shapes::box(70, 90, 200), {0.001, 0});
  EXPECT_NEAR(millimetres.built.extent[2], 0.2, 1e-6);
  EXPECT_FALSE(warned(millimetres.built, "units"));
  EXPECT_TRUE(warned(make(shapes::box(70, 90, 200)).built, "--units mm"));
  EXPECT_TRUE(warned(make(shapes::box(0.001, 0.002, 0.003)).built, "--units mm"));
  EXPECT_TRUE(warned(make(shapes::box(0.07, 0.09, 0.2), {0.001, 0}).built, "--units mm"));
  EXPECT_TRUE(warned(make(shapes::box(4.2, 1, 1)).built, "up to 4 m"));
}

TEST(ModelBuilder, ManagesWithUnsoundMeshes) {
  Geometry g = shapes::sphere(0.1, 50);
  const auto first = static_cast<std::uint32_t>(g.vertices.size());
  g.vertices.push_back({5, 5, 5});           // of no triangle
  g.vertices.push_back(g.vertices[0]);       // a double
  g.triangles.push_back({1, 1, 2});          // without area
  g.triangles.push_back({first + 1, 0, 3});  // the same vertex twice after welding
  g.triangles.push_back(g.triangles[200]);   // doubled
  const auto t = g.triangles[300];
  g.triangles.push_back({t[1], t[0], t[2]});  // doubled and turned over
  const Made made = make(g);
  EXPECT_LT(made.view().radius(), 0.101);
  EXPECT_TRUE(warned(made.built, "1 vertex of no triangle is left out"));
  EXPECT_GT(share_outward(made.view(), [](const Vector3& p, const Vector3& n) { return n.dot(p); }), 0.999);

  Geometry flat;  // triangles without area only: a cloud is left
  for (int i = 0; i < 60; ++i) flat.vertices.push_back({static_cast<float>(i), 0, 0});
  flat.triangles = {{0, 1, 2}, {3, 3, 3}};
  EXPECT_TRUE(warned(make(flat).built, "taken as a cloud"));
}

TEST(ModelBuilder, RefusesWhatNoModelCanBeMadeOf) {
  const auto error = [](const Geometry& g, const ModelBuildSettings& s = {}) {
    const Result<BuiltModel> built = build_model(g, s);
    EXPECT_FALSE(built);
    if (built) return std::string();
    EXPECT_EQ(built.error().kind, ErrorKind::bad_input);
    return built.error().message;
  };
  EXPECT_TRUE(mentions(error(Geometry()), "0 different points"));
  Geometry same;
  same.vertices.assign(1000, {1, 2, 3});
  EXPECT_TRUE(mentions(error(same), "1 different points"));
  EXPECT_TRUE(mentions(error(shapes::box(1, 1, 1), {0, 0}), "metres per unit"));
  EXPECT_TRUE(mentions(error(shapes::box(1, 1, 1), {1, -1}), "spacing"));
  EXPECT_TRUE(
      mentions(error(shapes::box(1, 1, 1), {1, std::numeric_limits<double>::quiet_NaN()}), "spacing"));
  EXPECT_TRUE(mentions(error(shapes::cloud_of(shapes::sphere(0.1, 50)), {1, 0.9}), "leaves"));
  Geometry far = shapes::sphere(0.1, 50);
  far.vertices.push_back({1e38F, 0, 0});
  far.triangles.push_back({500, 501, static_cast<std::uint32_t>(far.vertices.size() - 1)});
  EXPECT_TRUE(mentions(error(far), "from the origin"));
}

TEST(ModelBuilder, TheLeastObjectIsOneThatTheFormatHolds) {
  // Places in whole sixteenths of a millimetre lie up to 0.0541 mm off.
  for (const double radius : {5.5e-5, 6e-5, 1e-4}) {
    const Result<BuiltModel> built = build_model(shapes::sphere(radius, 50), {});
    ASSERT_TRUE(built) << radius << built.error().message;
    ModelView view;
    EXPECT_EQ(ModelView::open(built->image, view), ModelFault::none) << radius;
  }
  for (const double radius : {5.3e-5, 1e-5, 1e-6}) {
    const Result<BuiltModel> built = build_model(shapes::sphere(radius, 50), {});
    ASSERT_FALSE(built) << radius;
    EXPECT_EQ(built.error().kind, ErrorKind::bad_input);
    EXPECT_NE(built.error().message.find("--units"), std::string::npos) << built.error().message;
  }
}

TEST(ModelBuilder, TheHeaderFitsTheContents) {
  const Made made = make(shapes::cushion_with_knob());
  const ModelHeader& h = made.view().header();
  EXPECT_EQ(h.point_count, made.built.points);
  EXPECT_EQ(h.keypoint_count, made.built.keypoints);
  EXPECT_EQ(h.bytes, made.built.image.size());
  EXPECT_EQ(h.keypoint_count, limits::kMaxModelKeypoints);
  EXPECT_GT(h.support_radius, 3 * h.spacing);
  for (const Point3f& p : made.view().positions())
    EXPECT_LE((to_vector(p) - made.view().centre()).norm(), h.radius * (1 + 1e-12));
  std::size_t described = 0;
  for (const Descriptor& d : made.view().descriptors())
    described += std::any_of(d.bins.begin(), d.bins.end(), [](std::int8_t b) { return b > 0; }) ? 1U : 0U;
  EXPECT_GT(described, made.view().keypoint_count() * 9 / 10);
}

}  // namespace
}  // namespace pliant

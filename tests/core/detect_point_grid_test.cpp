#include "core/detect/point_grid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "core/detect/uniform_sampling.hpp"
#include "tests/core/bumpy_object.hpp"

namespace pliant {
namespace {

using testing::AlignedBlock;

std::vector<Point3f> random_points(std::size_t count, float scale) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> spread(-scale, scale);
  std::vector<Point3f> points(count);
  for (Point3f& p : points) p = {spread(random), spread(random), spread(random)};
  return points;
}

float square(const Point3f& a, const Point3f& b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z);
}

struct GridFixture {
  explicit GridFixture(std::span<const Point3f> points, double cell) : block(1 << 20) {
    Workspace workspace(block.span());
    grid.lay_out(workspace, points.size());
    built = grid.build(points, cell);
  }
  AlignedBlock block;
  PointGrid grid;
  bool built = false;
};

TEST(PointGrid, VisitsExactlyThePointsWithinTheRadius) {
  const std::vector<Point3f> points = random_points(2000, 1);
  for (const double cell : {0.05, 0.2, 3.0}) {
    GridFixture fixture(points, cell);
    ASSERT_TRUE(fixture.built);
    for (std::size_t q = 0; q < 50; ++q) {
      const float radius = 0.02F + 0.01F * static_cast<float>(q % 20);
      std::multiset<std::uint32_t> expected, visited;
      for (std::uint32_t i = 0; i < points.size(); ++i)
        if (square(points[q], points[i]) <= radius * radius) expected.insert(i);
      fixture.grid.visit_within(points[q], radius, 5000, [&](std::uint32_t i, const Point3f&, float s) {
        visited.insert(i);
        EXPECT_FLOAT_EQ(s, square(points[q], points[i]));
      });
      EXPECT_EQ(visited, expected);
    }
  }
}

TEST(PointGrid, NearestEqualsBruteForce) {
  const std::vector<Point3f> points = random_points(1500, 1);
  GridFixture fixture(points, 0.1);
  for (const Point3f& q : random_points(300, 1.3F)) {
    std::uint32_t expected = PointGrid::kNone;
    float best = 0.25F * 0.25F;
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if (square(q, points[i]) < best) {
        best = square(q, points[i]);
        expected = i;
      }
    float found = 0;
    EXPECT_EQ(fixture.grid.nearest(q, 0.25F, found), expected);
    if (expected != PointGrid::kNone) {
      EXPECT_FLOAT_EQ(found, best);
    }
  }
}

TEST(PointGrid, LeavesOutWhatIsNotFiniteAndBearsFarStrays) {
  std::vector<Point3f> points = random_points(100, 1);
  points[3].x = std::numeric_limits<float>::quiet_NaN();
  points[5].y = std::numeric_limits<float>::infinity();
  points[7] = {1e30F, -1e30F, 1e30F};
  GridFixture fixture(points, 0.1);
  ASSERT_TRUE(fixture.built);
  EXPECT_EQ(fixture.grid.size(), 98U);
  std::size_t visited = 0;
  fixture.grid.visit_within({0, 0, 0}, 4, 1000, [&](std::uint32_t i, const Point3f&, float) {
    EXPECT_TRUE(i != 3 && i != 5 && i != 7);
    ++visited;
  });
  EXPECT_EQ(visited, 97U);
}

TEST(PointGrid, WorkIsBoundedWhereAllPointsAreOne) {
  const std::vector<Point3f> points(5000, Point3f{1, 2, 3});
  GridFixture fixture(points, 0.1);
  std::size_t calls = 0;
  EXPECT_EQ(
      fixture.grid.visit_within({1, 2, 3}, 0.05F, 64, [&](std::uint32_t, const Point3f&, float) { ++calls; }),
      64U);
  EXPECT_EQ(calls, 64U);
  EXPECT_EQ(fixture.grid.visit_within({9, 9, 9}, 0.05F, 64, [](std::uint32_t, const Point3f&, float) {}), 0U);
}

TEST(PointGrid, RefusesTooManyPointsAndCellsWithoutSize) {
  const std::vector<Point3f> points = random_points(10, 1);
  AlignedBlock block(1 << 16);
  Workspace workspace(block.span());
  PointGrid grid;
  grid.lay_out(workspace, 5);
  EXPECT_FALSE(grid.build(points, 0.1));
  EXPECT_FALSE(grid.build(std::span(points).first(5), 0));
  EXPECT_FALSE(grid.build(std::span(points).first(5), std::numeric_limits<double>::quiet_NaN()));
}

TEST(UniformSampling, KeepsOnePointACell) {
  std::vector<Point3f> points = random_points(3000, 1);
  points.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  AlignedBlock block(1 << 20);
  Workspace workspace(block.span());
  UniformSampling sampling;
  sampling.lay_out(workspace, points.size());
  std::vector<std::uint32_t> kept(points.size());
  const std::size_t count = sampling.sample(points, 0.25, kept);
  std::set<std::tuple<int, int, int>> cells, all;
  const auto cell = [](const Point3f& p) {
    return std::tuple(static_cast<int>(std::floor(p.x / 0.25F)), static_cast<int>(std::floor(p.y / 0.25F)),
                      static_cast<int>(std::floor(p.z / 0.25F)));
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) all.insert(cell(points[i]));
  for (std::size_t k = 0; k < count; ++k) cells.insert(cell(points[kept[k]]));
  EXPECT_EQ(count, all.size());
  EXPECT_EQ(cells, all);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count)));
  EXPECT_EQ(sampling.sample({}, 0.25, kept), 0U);
  EXPECT_EQ(sampling.sample(points, 0, kept), 0U);
}

}  // namespace
}  // namespace pliant

#include "drivers/model_files/farthest_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace pliant {
namespace {

std::vector<Vector3> random_points(std::size_t count) {
  std::minstd_rand random(3);
  const auto next = [&] { return static_cast<double>(random() % 4096) / 4096; };
  std::vector<Vector3> points(count);
  for (Vector3& p : points) p = Vector3(next(), next(), next());
  return points;
}

/// The definition, word by word.
std::vector<std::uint32_t> plain_order(const std::vector<Vector3>& points) {
  Vector3 lowest = points[0], highest = points[0];
  for (const Vector3& p : points) {
    lowest = lowest.cwiseMin(p);
    highest = highest.cwiseMax(p);
  }
  std::vector<double> squares(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    squares[i] = (points[i] - 0.5 * (lowest + highest)).squaredNorm();
  std::vector<std::uint32_t> order;
  while (order.size() < points.size()) {
    const auto next =
        static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) - squares.begin());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double square = (points[i] - points[next]).squaredNorm();
      squares[i] = order.empty() ? square : std::min(squares[i], square);
    }
    order.push_back(static_cast<std::uint32_t>(next));
    for (const std::uint32_t i : order) squares[i] = -1;
  }
  return order;
}

TEST(FarthestPoint, IsTheDefinitionsOrder) {
  std::vector<Vector3> points = random_points(700);
  for (std::size_t i = 0; i < 40; ++i) points[i + 300] = points[i];  // doubles and many equal distances
  EXPECT_EQ(farthest_point_order(points, points.size()), plain_order(points));
}

TEST(FarthestPoint, EndsAtTheCountOrDistance) {
  const std::vector<Vector3> points = random_points(2000);
  EXPECT_EQ(farthest_point_order(points, 10).size(), 10U);
  const std::vector<std::uint32_t> far = farthest_point_order(points, points.size(), 0.2);
  EXPECT_GT(far.size(), 10U);
  for (std::size_t i = 0; i < far.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE((points[far[i]] - points[far[j]]).norm(), 0.2);
  EXPECT_TRUE(farthest_point_order({}, 5).empty());
  EXPECT_TRUE(farthest_point_order(points, 0).empty());
}

}  // namespace
}  // namespace pliant

#include "core/track/pose_lanes.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/core/synthetic.hpp"

namespace pliant {
namespace {

// Up to the corners of the largest model, before and behind the camera, and with axes that stay what they
// are.
TEST(PoseLanes, SumWhatThePosesSayOfAPoint) {
  std::mt19937 random(5);
  const auto within = [&](std::int32_t most) {
    return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(2 * most + 1)) - most;
  };
  const auto metres = [&](double most) { return most * within(1000) / 1000.0; };
  for (int i = 0; i < 20000; ++i) {
    const auto x = static_cast<std::int16_t>(within(32000)), y = static_cast<std::int16_t>(within(32000)),
               z = static_cast<std::int16_t>(within(32000));
    PointSum sum(x, y, z, 64);
    IntPoint expected{64, 64, 64};
    std::int32_t rest = 128;
    for (int k = 0; k < 4; ++k) {
      const Vector3 axis(metres(1), metres(1), metres(1) + 1.001);
      const double angle = i % 5 == 0 ? 1.5707963267948966 * (k - 1) : metres(3.1);
      const FixedPose pose(
          synthetic::pose_at({metres(4), metres(4), metres(8)}, i % 5 == 0 ? Vector3(0, 0, 1) : axis, angle),
          Vector3::Zero());
      const std::int32_t weight = k == 3 ? rest : static_cast<std::int32_t>(random()) & (rest / 2);
      rest -= weight;
      sum.add(PoseLanes(pose), weight);
      const IntPoint p = pose.point(x, y, z);
      expected = {expected.x + weight * p.x, expected.y + weight * p.y, expected.z + weight * p.z};
    }
    const IntPoint got = sum.over(7);
    ASSERT_EQ(got.x, expected.x >> 7);
    ASSERT_EQ(got.y, expected.y >> 7);
    ASSERT_EQ(got.z, expected.z >> 7);
  }
}

}  // namespace
}  // namespace pliant

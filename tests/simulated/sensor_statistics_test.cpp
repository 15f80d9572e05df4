// The simulated sensor beside a real one: the same statistics of still scenes at the same picture size.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "drivers/recording/recording.hpp"
#include "drivers/simulated/simulated.hpp"
#include "tests/simulated/still_statistics.hpp"

namespace pliant {
namespace {

/// A PrimeSense sensor at 320x240, frames 0 to 30 of the recording real_plush_squirrel: a plush toy, a table
/// and clutter at 0.45 to 0.8 m, untouched. Measured by statistics_of().
constexpr StillStatistics kReal{1.553, 0.472, 0.283, 0.0031, 0.321, 0.095};

StillScene take(DepthSource& source, int count) {
  StillScene scene{source.intrinsics().width, source.intrinsics().height, {}};
  SourceItem item;
  for (int i = 0; i < count; ++i) {
    source.next(5000, item);
    if (item.event != SourceEvent::frame) break;
    const DepthFrame& f = item.frame;
    scene.frames.emplace_back(f.depth, f.depth + static_cast<std::ptrdiff_t>(f.width) * f.height);
  }
  return scene;
}

void print(const std::string& name, const StillStatistics& s) {
  std::printf(
      "%-9s step %.3f mm  flicker %.3f  correlation %.3f  lost inside %.4f  at edges %.3f  flying %.3f\n",
      name.c_str(), s.step, s.flicker, s.correlation, s.lost_inside, s.lost_at_edges, s.flying_at_edges);
}

class SensorStatistics : public testing::TestWithParam<const char*> {};

TEST_P(SensorStatistics, OfAStillSceneAreThoseOfARealSensor) {
  auto source = open_simulated(std::string(GetParam()) + "?width=320&height=240&frames=15");
  ASSERT_TRUE(source);
  const StillStatistics s = statistics_of(take(**source, 15));
  print(GetParam(), s);
  EXPECT_NEAR(s.step, kReal.step, 0.06);
  EXPECT_NEAR(s.flicker / kReal.flicker, 1, 0.15);
  EXPECT_NEAR(s.correlation, kReal.correlation, 0.1);
  EXPECT_GT(s.lost_inside, kReal.lost_inside / 2);
  EXPECT_LT(s.lost_inside, kReal.lost_inside * 2);
  EXPECT_GT(s.lost_at_edges, kReal.lost_at_edges / 2);
  EXPECT_LT(s.lost_at_edges, kReal.lost_at_edges * 2);
  EXPECT_GT(s.flying_at_edges, kReal.flying_at_edges / 2);
  EXPECT_LT(s.flying_at_edges, kReal.flying_at_edges * 2);
}

INSTANTIATE_TEST_SUITE_P(All, SensorStatistics, testing::Values("cushion", "figure", "box"));

TEST(RealSensor, HasTheStatedStatistics) {
  const std::filesystem::path folder = std::filesystem::path(PLIANT_SHARED_DATA) / "real_plush_squirrel";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data beside the repository";
  auto source = open_recording(folder);
  ASSERT_TRUE(source) << source.error().message;
  const StillStatistics s = statistics_of(take(**source, 31));
  print("real", s);
  EXPECT_NEAR(s.step, kReal.step, 0.02);
  EXPECT_NEAR(s.flicker, kReal.flicker, 0.02);
  EXPECT_NEAR(s.correlation, kReal.correlation, 0.02);
  EXPECT_NEAR(s.lost_inside, kReal.lost_inside, 0.0005);
  EXPECT_NEAR(s.lost_at_edges, kReal.lost_at_edges, 0.01);
  EXPECT_NEAR(s.flying_at_edges, kReal.flying_at_edges, 0.005);
}

}  // namespace
}  // namespace pliant

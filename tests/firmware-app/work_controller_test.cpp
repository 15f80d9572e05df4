#include "firmware-app/pipeline/work_controller.hpp"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(WorkController, WithoutABudgetNothingIsShed) {
  WorkController work(0);
  EXPECT_EQ(work.next_level(1'000'000'000), 1.0);
  EXPECT_EQ(work.misses(), 0);
}

TEST(WorkController, SettlesBelowTheBudget) {
  WorkController work(10'000'000);
  double level = 1;
  std::int64_t took = 0;
  for (int frame = 0; frame < 300; ++frame) {
    took = 4'000'000 + static_cast<std::int64_t>(level * 12e6);  // 16 ms at full work
    level = work.next_level(took);
    EXPECT_GE(level, 0.0);
    EXPECT_LE(level, 1.0);
  }
  EXPECT_LE(took, 11'000'000);
  EXPECT_GT(work.misses(), 0);
  EXPECT_LT(work.misses(), 60);
  EXPECT_LT(work.least_level(), 0.6);
}

TEST(WorkController, RecoversWhenThePressureIsGone) {
  WorkController work(10'000'000);
  static_cast<void>(work.next_level(40'000'000));
  double level = 0;
  for (int frame = 0; frame < 60; ++frame) level = work.next_level(1'000'000);
  EXPECT_EQ(level, 1.0);
}

}  // namespace
}  // namespace pliant

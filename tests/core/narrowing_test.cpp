// The widths that regions are looked for at, round by round.
#include "core/track/narrowing.hpp"

#include <gtest/gtest.h>

namespace pliant {
namespace {

constexpr double kSigma = 0.001;

class NarrowingOfTwo : public testing::Test {
 protected:
  NarrowingOfTwo() {
    for (std::size_t i = 0; i < widths_.size(); ++i)
      widths_[i] = {{100 * (i + 1), static_cast<std::int32_t>(400 - 100 * i)},
                    static_cast<std::int32_t>(300 - 50 * i)};
    regions_[0].alive = regions_[1].alive = true;
  }
  /// One round, in which the two move by so many σ.
  static void move(Narrowing& narrowing, double base, double part) {
    AlignSteps steps = for_every_region(-1.0);
    steps[0] = base * kSigma;
    steps[1] = part * kSigma;
    narrowing.go_on(steps);
  }

  SearchWidths widths_;
  RegionSet regions_;
};

TEST_F(NarrowingOfTwo, GoesFromWidthToWidthWhileTheyMove) {
  Narrowing narrowing(widths_, kSigma, regions_);
  for (const SearchWidth& width : widths_) {
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(narrowing.reaches()[k].points, width.reach.points);
      EXPECT_EQ(narrowing.reaches()[k].gate, width.reach.gate);
      EXPECT_EQ(narrowing.widest()[k], width.widest);
    }
    move(narrowing, 1, 1);
  }
  EXPECT_EQ(narrowing.widest()[0], widths_.back().widest) << "the last width stays until they are at rest";
  EXPECT_FALSE(narrowing.at_rest());
}

TEST_F(NarrowingOfTwo, WhatIsWhereItWasExpectedGoesToTheLastWidth) {
  Narrowing narrowing(widths_, kSigma, regions_);
  move(narrowing, 0.2, 1);
  EXPECT_EQ(narrowing.widest()[0], widths_.back().widest);
  EXPECT_EQ(narrowing.widest()[1], widths_[1].widest);
}

TEST_F(NarrowingOfTwo, LooksNoMoreForWhatIsAtRest) {
  Narrowing narrowing(widths_, kSigma, regions_);
  move(narrowing, 0.05, 1);
  EXPECT_GT(narrowing.reaches()[0].points, 0U) << "not before the last width said so";
  move(narrowing, 0.05, 1);
  EXPECT_EQ(narrowing.reaches()[0].points, 0U);
  EXPECT_GT(narrowing.reaches()[1].points, 0U);
  EXPECT_FALSE(narrowing.at_rest());
  move(narrowing, -1, 0.05);
  move(narrowing, -1, 0.05);
  EXPECT_TRUE(narrowing.at_rest());
}

TEST_F(NarrowingOfTwo, WhatHasTooFewReadingsIsNotTakenForWhereItWasExpected) {
  Narrowing narrowing(widths_, kSigma, regions_);
  move(narrowing, 1, -1);
  EXPECT_EQ(narrowing.widest()[1], widths_[1].widest);
  move(narrowing, 1, -1);
  move(narrowing, 1, -1);
  move(narrowing, 1, -1);
  EXPECT_EQ(narrowing.reaches()[1].points, 0U) << "but asking the last width again tells nothing";
}

TEST_F(NarrowingOfTwo, NeverLooksForWhatIsNotThere) {
  regions_[1].alive = false;
  Narrowing narrowing(widths_, kSigma, regions_);
  for (int round = 0; round < kMostRounds; ++round) {
    EXPECT_EQ(narrowing.reaches()[1].points, 0U);
    move(narrowing, 1, -1);
  }
  EXPECT_FALSE(narrowing.at_rest());
}

}  // namespace
}  // namespace pliant

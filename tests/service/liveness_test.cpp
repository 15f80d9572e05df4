#include "firmware-app/service/liveness.hpp"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(Liveness, NothingMovedIsNoLife) {
  Liveness liveness;
  EXPECT_FALSE(liveness.look({0, 0, 0}));
  EXPECT_TRUE(liveness.look({1, 0, 0}));
  EXPECT_FALSE(liveness.look({1, 0, 0}));
}

TEST(Liveness, HonestWaitingIsLife) {
  Liveness liveness;
  for (std::uint64_t answers = 1; answers < 5; ++answers) EXPECT_TRUE(liveness.look({answers, 7, 7}));
}

TEST(Liveness, AFrameThatNeverEndsIsNone) {
  Liveness stuck;
  EXPECT_TRUE(stuck.look({5, 5, 4}));  // a frame was finished since the beginning
  EXPECT_FALSE(stuck.look({6, 5, 4}));
  EXPECT_FALSE(stuck.look({90, 5, 4}));
  EXPECT_TRUE(stuck.look({90, 5, 5}));
}

TEST(Liveness, ASourceThatNeverAnswersIsNone) {
  Liveness liveness;
  EXPECT_TRUE(liveness.look({9, 9, 8}));
  EXPECT_TRUE(liveness.look({9, 9, 9}));
  EXPECT_FALSE(liveness.look({9, 9, 9}));
}

TEST(Liveness, ARunThatBeginsAnewIsLife) {
  Liveness liveness;
  EXPECT_TRUE(liveness.look({100, 90, 90}));
  EXPECT_TRUE(liveness.look({1, 0, 0}));
}

}  // namespace
}  // namespace pliant

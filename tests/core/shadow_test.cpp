#include "core/track/shadow.hpp"

#include <gtest/gtest.h>

#include "tests/core/observed_surface.hpp"

namespace pliant {
namespace {

using synthetic::Observed;
using synthetic::Picture;

constexpr std::int32_t kAt = 1000 * kUnitsPerMillimetre, kNearer = 16 * kUnitsPerMillimetre;

/// A wall 1 m away whose columns 100 to 109 have no reading.
class Shadow : public ::testing::Test {
 protected:
  Shadow() {
    picture_.wall(1.0);
    picture_.block(100, 0, 110, 240, 0);
  }
  bool at(int u, int step = 1) {
    observed_.build(picture_);
    return in_shadow(observed_.surface, u, 120, kAt, kNearer, step);
  }
  Picture picture_{synthetic::small_camera()};
  Observed observed_;
};

TEST_F(Shadow, LiesToTheLeftOfWhatThrowsIt) {
  picture_.block(110, 0, 120, 240, 0.8);
  EXPECT_TRUE(at(105));
  EXPECT_TRUE(at(101));
}

TEST_F(Shadow, IsNoneToTheRightOfSomethingNearer) {
  picture_.block(90, 0, 100, 240, 0.8);
  EXPECT_FALSE(at(105));
}

TEST_F(Shadow, IsNoneBesideTheSameSurface) {
  EXPECT_FALSE(at(105));
  picture_.block(110, 0, 120, 240, 0.99);
  EXPECT_FALSE(at(105)) << "as deep as the object itself";
}

TEST_F(Shadow, EndsAtTheFirstReading) {
  picture_.block(114, 0, 130, 240, 0.8);
  EXPECT_FALSE(at(105));
}

TEST_F(Shadow, IsLookedForAsFarAsTheStepsReach) {
  picture_.block(100, 0, 130, 240, 0);
  picture_.block(130, 0, 150, 240, 0.8);
  EXPECT_FALSE(at(102));
  EXPECT_TRUE(at(102, 8));
  EXPECT_FALSE(at(319, 8)) << "outside the picture is nothing";
}

}  // namespace
}  // namespace pliant

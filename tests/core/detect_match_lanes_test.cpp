#include "core/detect/match_lanes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "tests/core/bumpy_object.hpp"

namespace pliant {
namespace {

constexpr std::size_t kMatches = 301;  // no whole number of vectors

/// Matches of which every third is moved by the true pose, the others anywhere; with room for their lanes.
struct Matches {
  Matches() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-0.2, 0.2);
    for (std::vector<float>& lane : room) lane.resize(kMatches);
    lanes = {room[0], room[1], room[2], room[3], room[4], room[5]};
    for (std::size_t i = 0; i < kMatches; ++i) {
      model.emplace_back(unit(random), unit(random), unit(random));
      const Vector3 elsewhere(unit(random), unit(random), 1 + unit(random));
      const Vector3 noise = 0.1 * Vector3(unit(random), unit(random), unit(random));
      scene.push_back(i % 3 == 0 ? pose * model.back() + noise : elsewhere);
      lanes.put(i, to_point(model.back()), to_point(scene.back()));
    }
  }
  [[nodiscard]] double keeps(std::size_t i, std::size_t seed) const {
    return std::fabs((model[i] - model[seed]).norm() - (scene[i] - scene[seed]).norm());
  }
  [[nodiscard]] double off(std::size_t i) const { return (pose * model[i] - scene[i]).norm(); }

  RigidTransform pose = testing::test_pose(0.9, Vector3(1, 2, -1), Vector3(0.1, 0.2, 1));
  std::vector<Vector3> model, scene;
  std::array<std::vector<float>, 6> room;
  MatchLanes lanes;
};

// Where single precision may decide either way, any answer is right.
constexpr double kEither = 1e-6;

TEST(MatchLanes, MatchesThatKeepTheirDistanceToASeedAreHits) {
  const Matches m;
  std::vector<std::int32_t> hits(kMatches);
  constexpr double kTolerance = 0.02;
  const std::uint32_t sum = m.lanes.consistent_with(9, static_cast<float>(kTolerance), hits);
  std::uint32_t counted = 0;
  for (std::size_t i = 0; i < kMatches; ++i) {
    counted += hits[i] != 0 ? 1U : 0U;
    if (std::fabs(m.keeps(i, 9) - kTolerance) < kEither) continue;
    EXPECT_EQ(hits[i], m.keeps(i, 9) <= kTolerance ? 1 : 0) << i;
  }
  EXPECT_EQ(sum, counted);
  EXPECT_GT(sum, kMatches / 10);
  EXPECT_LT(sum, kMatches * 9 / 10);
}

TEST(MatchLanes, WhatAPoseExplainsGrowsWithTheDistance) {
  const Matches m;
  std::vector<std::int32_t> hits(kMatches);
  constexpr double kTolerance = 0.01, kGrowth = 0.05;
  m.lanes.explained_by(FastTransform(m.pose), to_point(m.model[9]), static_cast<float>(kTolerance),
                       static_cast<float>(kGrowth), hits);
  std::uint32_t agreeing = 0;
  for (std::size_t i = 0; i < kMatches; ++i) {
    const double limit = kTolerance + kGrowth * (m.model[i] - m.model[9]).norm();
    if (std::fabs(m.off(i) - limit) > kEither) {
      EXPECT_EQ(hits[i], m.off(i) <= limit ? 1 : 0) << i;
    }
    agreeing += m.off(i) <= limit && m.keeps(i, 9) <= kTolerance ? 1U : 0U;
  }
  EXPECT_EQ(m.lanes.count_agreeing(9, FastTransform(m.pose), static_cast<float>(kTolerance),
                                   static_cast<float>(kGrowth), kMatches),
            agreeing);
  EXPECT_GT(agreeing, kMatches / 20);
}

}  // namespace
}  // namespace pliant

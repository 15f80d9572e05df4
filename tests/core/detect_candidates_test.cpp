#include <gtest/gtest.h>

#include <vector>

#include "core/detect/pose_candidates.hpp"
#include "core/detect/spread_order.hpp"
#include "tests/core/bumpy_object.hpp"

namespace pliant {
namespace {

PoseCandidate candidate(double score, const Vector3& at, double degrees = 0, double close = 1) {
  PoseCandidate c;
  c.pose = testing::test_pose(degrees * M_PI / 180, Vector3(0.3, 1, 0.2), at);
  c.score = score;
  c.evidence.facing = 200;
  c.evidence.agreeing = 100;
  c.evidence.close = static_cast<int>(100 * close);
  return c;
}

PoseCandidates candidates() {
  PoseCandidates all;
  all.start(Vector3::Zero(), 0.1);
  return all;
}

TEST(PoseCandidates, OneAPlaceTheBetterStays) {
  PoseCandidates all = candidates();
  all.keep(candidate(0.4, Vector3(0, 0, 1)));
  all.keep(candidate(0.5, Vector3(0.01, 0, 1), 5));
  all.keep(candidate(0.3, Vector3(0, 0.01, 1), -5));
  ASSERT_EQ(all.all().size(), 1U);
  EXPECT_EQ(all.all()[0].score, 0.5);
}

TEST(PoseCandidates, WhenFullTheWorstGoes) {
  PoseCandidates all = candidates();
  for (std::size_t k = 0; k < PoseCandidates::kMost; ++k) {
    EXPECT_EQ(all.floor(), -10);
    all.keep(candidate(0.1 + 0.01 * static_cast<double>(k), Vector3(static_cast<double>(k), 0, 1)));
  }
  EXPECT_EQ(all.floor(), 0.1);
  all.keep(candidate(0.05, Vector3(-1, 0, 1)));
  EXPECT_EQ(all.floor(), 0.1);
  all.keep(candidate(0.9, Vector3(-2, 0, 1)));
  EXPECT_EQ(all.floor(), 0.11);
  EXPECT_EQ(all.all().size(), PoseCandidates::kMost);
  EXPECT_EQ(all.best().score, 0.9);
}

TEST(PoseCandidates, RivalsStandElsewhereTwinsTurnOnTheSpot) {
  PoseCandidates all = candidates();
  all.keep(candidate(0.6, Vector3(0, 0, 1)));
  all.keep(candidate(0.2, Vector3(0.5, 0, 1)));
  all.keep(candidate(0.3, Vector3(0, 0.02, 1), 90));
  const Detection best = all.best();
  EXPECT_DOUBLE_EQ(best.rival, 0.2);
  EXPECT_DOUBLE_EQ(best.twin, 0.3);
}

TEST(PoseCandidates, WhatCameToTheBestPoseIsNoTwin) {
  PoseCandidates all = candidates();
  all.keep(candidate(0.6, Vector3(0, 0, 1)));
  all.keep(candidate(0.5, Vector3(0, 0, 1), 60));
  all.all()[1].pose = all.all()[0].pose;  // as refinement does
  EXPECT_EQ(all.best().twin, -10);
}

TEST(PoseCandidates, ARivalThatNoiseDoesNotExplainWeighsLess) {
  PoseCandidates all = candidates();
  all.keep(candidate(0.6, Vector3(0, 0, 1), 0, 0.98));
  all.keep(candidate(0.5, Vector3(0.5, 0, 1), 0, 0.82));
  EXPECT_NEAR(all.best().rival, 0.5 * 0.04 / 0.20, 1e-9);
}

TEST(PoseCandidates, WhatWasDismissedGivesWayToTheNextBest) {
  PoseCandidates all = candidates();
  all.keep(candidate(0.9, Vector3(0, 0, 1)));
  all.keep(candidate(0.8, Vector3(0, 0.01, 1), 90));
  all.keep(candidate(0.6, Vector3(0.5, 0, 1)));
  all.dismiss(all.best());
  Detection best = all.best();
  EXPECT_EQ(best.score, 0.6);
  EXPECT_EQ(best.rival, -10);
  all.keep(candidate(0.85, Vector3(0.02, 0, 1), 180));  // the ball again
  EXPECT_EQ(all.best().score, 0.6);
  all.keep(candidate(0.95, Vector3(0.02, 0, 1), 180));  // better than the ball was: the object
  EXPECT_EQ(all.best().score, 0.95);
  all.dismiss(all.best());
  all.dismiss(all.best());
  EXPECT_EQ(all.best().score, -10);
}

TEST(PoseCandidates, TwinsCountAsTheCallerSays) {
  PoseCandidates all = candidates();
  all.keep(candidate(0.6, Vector3(0, 0, 1)));
  all.keep(candidate(0.5, Vector3(0, 0, 1), 90));
  all.keep(candidate(0.4, Vector3(0, 0, 1), 180));
  const Detection best = all.best();
  EXPECT_EQ(all.best_twin(best, [](const RigidTransform&) { return true; }), 0.5);
  const RigidTransform& nearer = all.all()[1].pose;
  EXPECT_EQ(all.best_twin(best, [&](const RigidTransform& pose) { return pose.rotation != nearer.rotation; }),
            0.4);
  EXPECT_EQ(all.best_twin(best, [](const RigidTransform&) { return false; }), -10);
}

Detection detection(double score, double rival, double twin, double close) {
  Detection d;
  d.score = score;
  d.rival = rival;
  d.twin = twin;
  d.evidence = candidate(score, Vector3::Zero(), 0, close).evidence;
  return d;
}

TEST(Verdict, BelievesWhatStandsOutAndFits) {
  EXPECT_TRUE(verdict_on(detection(0.7, 0.5, 0.6, 0.8)).convincing);  // beyond doubt
  EXPECT_TRUE(verdict_on(detection(0.4, 0.1, -10, 0.8)).convincing);  // alone, one attitude
  EXPECT_FALSE(verdict_on(detection(0.31, 0.11, 0.03, 0.91)).convincing);
  EXPECT_TRUE(verdict_on(detection(0.31, 0.11, 0.03, 0.91)).likely);  // but for the descriptors
  EXPECT_TRUE(
      verdict_on(detection(0.31, 0.11, -0.1, 0.96)).convincing);  // noise explains it, nothing else fits
  EXPECT_FALSE(verdict_on(detection(0.31, 0.16, -0.1, 0.96)).likely);
  EXPECT_FALSE(verdict_on(detection(0.4, 0.3, -10, 0.99)).convincing);  // another place is nearly as good
  EXPECT_FALSE(verdict_on(detection(0.47, 0, 0.4, 0.83)).convincing);   // any attitude fits: something round
  EXPECT_FALSE(verdict_on(detection(0.32, -10, 0.08, 0.8)).convincing);
  EXPECT_FALSE(verdict_on(detection(0.25, -10, -10, 0.99)).convincing);
}

TEST(Verdict, AWeakFitMayComeAgainWhereItStandsAlone) {
  EXPECT_TRUE(verdict_on(detection(0.27, 0.05, 0.02, 0.95)).again);
  EXPECT_FALSE(verdict_on(detection(0.27, 0.05, 0.02, 0.95)).convincing);
  EXPECT_FALSE(verdict_on(detection(0.27, 0.05, 0.02, 0.85)).again);  // too much is left unexplained
  EXPECT_FALSE(verdict_on(detection(0.27, 0.05, 0.05, 0.95)).again);  // another attitude fits as well
  EXPECT_FALSE(verdict_on(detection(0.27, 0.15, 0.02, 0.95)).again);  // so does another place
  EXPECT_FALSE(verdict_on(detection(0.21, 0.05, -0.1, 0.95)).again);
}

TEST(Verdict, LastResortNeedsAClearFieldToo) {
  EXPECT_TRUE(verdict_on(detection(0.25, -10, -0.1, 0.85)).last_resort);
  EXPECT_FALSE(verdict_on(detection(0.2, -10, 0.03, 0.9)).last_resort);  // clutter of a like shape
  EXPECT_FALSE(verdict_on(detection(0.25, 0.2, -0.1, 0.8)).last_resort);
  EXPECT_FALSE(verdict_on(detection(0.25, -10, 0.2, 0.99)).last_resort);
  EXPECT_FALSE(verdict_on(detection(0.15, -10, -10, 0.99)).last_resort);
  Detection half_outside = detection(0.25, -10, -10, 0.99);
  half_outside.evidence.outside = 100;
  EXPECT_FALSE(verdict_on(half_outside).last_resort);
}

TEST(PoseCandidates, WhatNoiseExplainsAndNothingElseFitsIsClearAtALowerScore) {
  EXPECT_TRUE(verdict_on(detection(0.21, -10, -0.1, 0.96)).clear);
  EXPECT_TRUE(verdict_on(detection(0.21, -10, -0.1, 0.96)).last_resort);
  EXPECT_FALSE(verdict_on(detection(0.21, -10, -0.1, 0.9)).clear);    // a tenth that noise does not explain
  EXPECT_FALSE(verdict_on(detection(0.21, -10, 0.03, 0.98)).clear);   // another attitude fits a little
  EXPECT_FALSE(verdict_on(detection(0.21, 0.12, -0.1, 0.98)).clear);  // so does another place
  EXPECT_FALSE(verdict_on(detection(0.17, -10, -0.1, 1)).clear);
  EXPECT_FALSE(verdict_on(detection(0.21, -10, -0.1, 0.96)).convincing);
}

TEST(SpreadOrder, VisitsEachOnceAndPrefixesAreSpread) {
  for (const std::size_t count : {1U, 2U, 3U, 10U, 144U, 233U, 1000U, 4099U}) {
    const SpreadOrder order(count);
    std::vector<int> visits(count, 0);
    std::size_t at = 0;
    for (std::size_t k = 0; k < count; ++k, at = order.next(at)) ++visits[at];
    for (const int v : visits) EXPECT_EQ(v, 1) << count;
  }
  // Ten of a thousand: no two within a twenty-fifth.
  const SpreadOrder order(1000);
  std::vector<std::size_t> first;
  for (std::size_t k = 0, at = 0; k < 10; ++k, at = order.next(at)) first.push_back(at);
  std::sort(first.begin(), first.end());
  for (std::size_t k = 1; k < first.size(); ++k) EXPECT_GT(first[k] - first[k - 1], 40U);
}

}  // namespace
}  // namespace pliant

#include "core/detect/pose_votes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/core/bumpy_object.hpp"

namespace pliant {
namespace {

constexpr double kRadius = 0.15;

/// Votes on poses of a model around (0.01, 0, 0).
struct Poll {
  Poll() : block(1 << 20) {
    Workspace workspace(block.span());
    votes.lay_out(workspace, 4096, 1024);
    votes.start(Vector3(0.01, 0, 0), kRadius);
  }
  testing::AlignedBlock block;
  PoseVotes votes;
};

RigidTransform somewhere(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vector3 axis(unit(random), unit(random), unit(random));
  return testing::test_pose(3 * unit(random), axis, Vector3(unit(random), unit(random), 1.5 + unit(random)));
}

/// `pose`, off as a local frame is off: by some degrees and millimetres.
RigidTransform nearly(const RigidTransform& pose, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-0.1, 0.1);
  RigidTransform out = pose;
  out.rotation = rotation_from_small_vector({unit(random), unit(random), unit(random)}) * pose.rotation;
  out.translation += 0.05 * Vector3(unit(random), unit(random), unit(random));
  return out;
}

TEST(PoseVotes, AgreeingPosesStandOutAndTheirMeanIsNearer) {
  Poll poll;
  std::mt19937 random(3);
  const RigidTransform truth = testing::test_pose(1.2, Vector3(1, 2, 0), Vector3(0.1, 0, 1.2));
  // Three rounds; in each, two keypoints of 250 are right: too few by themselves.
  double worst = 0;
  std::size_t key = 0;
  for (int round = 0; round < 3; ++round) {
    const std::size_t first = poll.votes.size();
    for (int k = 0; k < 250; ++k, ++key) {
      const bool right = k % 125 == 60;
      const RigidTransform pose = right ? nearly(truth, random) : somewhere(random);
      if (right) worst = std::max(worst, testing::degrees_between(pose.rotation, truth.rotation));
      poll.votes.add(pose, key);
    }
    poll.votes.index();
    poll.votes.count_votes(first, poll.votes.size());
  }
  std::array<std::uint32_t, 8> best{};
  ASSERT_GE(poll.votes.best(best), 1U);
  EXPECT_EQ(poll.votes.votes(best[0]), 5U);
  const RigidTransform mean = poll.votes.mean_pose(best[0]);
  EXPECT_LT(testing::degrees_between(mean.rotation, truth.rotation), worst);
  const Vector3 centre(0.01, 0, 0);
  EXPECT_LT((mean * centre - truth * centre).norm(), 0.006);
}

TEST(PoseVotes, OneKeypointHasOneVote) {
  Poll poll;
  std::mt19937 random(4);
  const RigidTransform truth = testing::test_pose(0.4, Vector3(0, 2, 1), Vector3(0, 0, 1));
  for (int k = 0; k < 6; ++k) poll.votes.add(nearly(truth, random), 0);
  poll.votes.add(nearly(truth, random), 1);
  poll.votes.index();
  poll.votes.count_votes(0, poll.votes.size());
  EXPECT_EQ(poll.votes.votes(0), 1U);
  EXPECT_EQ(poll.votes.votes(6), 1U);
}

TEST(PoseVotes, ASpentClusterDoesNotComeBack) {
  Poll poll;
  std::mt19937 random(5);
  const RigidTransform one = testing::test_pose(0.4, Vector3(0, 2, 1), Vector3(0, 0, 1)),
                       other = testing::test_pose(2.4, Vector3(0, 2, 1), Vector3(0.3, 0, 1));
  for (std::size_t k = 0; k < 4; ++k) poll.votes.add(nearly(one, random), k);
  for (std::size_t k = 4; k < 6; ++k) poll.votes.add(nearly(other, random), k);
  poll.votes.index();
  poll.votes.count_votes(0, poll.votes.size());
  std::array<std::uint32_t, 8> best{};
  ASSERT_EQ(poll.votes.best(best), 2U);
  EXPECT_LT(best[0], 4U);
  EXPECT_GE(best[1], 4U);
  poll.votes.spend(best[0]);
  ASSERT_EQ(poll.votes.best(best), 1U);
  EXPECT_GE(best[0], 4U);
}

TEST(PoseVotes, WorkIsBoundedWhenAllAgree) {
  Poll poll;
  const RigidTransform pose = testing::test_pose(0.4, Vector3(0, 2, 1), Vector3(0, 0, 1));
  for (std::size_t k = 0; k < 4096; ++k) poll.votes.add(pose, k / 4);
  poll.votes.index();
  poll.votes.count_votes(0, poll.votes.size());
  EXPECT_GT(poll.votes.votes(100), 10U);
  EXPECT_LE(poll.votes.votes(100), PoseVotes::kMostNeighbours);
  poll.votes.add(pose, 0);  // full: ignored
  EXPECT_EQ(poll.votes.size(), 4096U);
}

}  // namespace
}  // namespace pliant

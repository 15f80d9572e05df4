// The tracker end to end on the simulated sensor, against its truth.
#include "tests/integration/run.hpp"

namespace pliant::test {
namespace {

double median(const Histogram& histogram) {
  return static_cast<double>(histogram.median());
}

/// What must hold for every object: found soon, kept, right.
void expect_followed(const SimulatedRun& run, double share) {
  const RunFigures& figures = run.end.figures;
  EXPECT_GE(figures.first_tracked, 0);
  EXPECT_LE(figures.first_tracked, 10);
  EXPECT_EQ(figures.dropped, 0);
  EXPECT_GE(static_cast<double>(run.check->present_and_tracked()),
            share * static_cast<double>(run.check->present() - figures.first_tracked));
  EXPECT_EQ(run.check->claimed_while_gone(), 0);
  EXPECT_LE(median(run.check->base_shift()), 1500);  // µm
  EXPECT_LE(median(run.check->base_angle()), 500);   // thousandths of a degree
  EXPECT_LE(median(run.check->position()), 2000);    // µm
  if (figures.heap_watched) {
    EXPECT_EQ(figures.heap_calls, 0U);
  }
}

TEST(Simulated, PressedCushionIsFollowed) {
  SimulatedRun run;
  run_simulated("simulated:cushion", run);
  expect_followed(run, 0.99);
}

TEST(Simulated, JointedFigureIsFollowed) {
  SimulatedRun run;
  run_simulated("simulated:figure", run);
  expect_followed(run, 0.99);
}

TEST(Simulated, BoxIsFollowedAndFoundAgain) {
  SimulatedRun run;
  run_simulated("simulated:box", run);
  // It is carried out of the picture and must be found again when it is back: a share of the frames is spent.
  expect_followed(run, 0.8);
  EXPECT_GT(run.end.figures.lost, 0);
  EXPECT_EQ(run.end.figures.last_state, TrackState::tracking);
}

TEST(Simulated, OtherNoiseAndFrameSizesDoNotMatter) {
  for (const char* uri :
       {"simulated:cushion?seed=7&frames=120", "simulated:cushion?frames=120&width=320&height=240"}) {
    SimulatedRun run;
    run_simulated(uri, run);
    expect_followed(run, 0.99);
  }
}

TEST(Simulated, TheSameInputGivesTheSameOutput) {
  SimulatedRun first, second, other;
  run_simulated("simulated:figure?frames=60&width=320&height=240", first);
  run_simulated("simulated:figure?frames=60&width=320&height=240", second);
  run_simulated("simulated:figure?frames=60&width=320&height=240&seed=2", other);
  EXPECT_EQ(first.end.figures.output_sha256, second.end.figures.output_sha256);
  EXPECT_NE(first.end.figures.output_sha256, other.end.figures.output_sha256);
}

}  // namespace
}  // namespace pliant::test

// Captures of the simulated objects against their true meshes.
#include <gtest/gtest.h>

#include "tests/accuracy/capture_score.hpp"

namespace pliant::test {
namespace {

class CaptureAccuracy : public testing::TestWithParam<const char*> {};

TEST_P(CaptureAccuracy, TheSurfaceIsThatOfTheTrueMesh) {
  const std::unique_ptr<SimulatedSource> source = simulated(GetParam());
  ASSERT_NE(source, nullptr);
  CaptureRun run;
  run.run(*source);
  run.finish();
  run.compare();
  const CaptureScore& s = run.score;
  std::printf(
      "%s: median %.2f mm, p95 %.2f mm, coverage %.1f %%, seam %.2f mm, drift %.2f mm (last %.2f), fused "
      "%lld of "
      "%lld, %zu keyframes, pairs %u, joint %.2f -> %.2f, moved %.2f mm, %zu vertices\n",
      GetParam(), 1e3 * s.median, 1e3 * s.p95, 100 * s.coverage, 1e3 * s.seam, 1e3 * s.drift,
      1e3 * run.last_off.translation.norm(), static_cast<long long>(s.fused),
      static_cast<long long>(s.frames), s.keyframes, s.joint.pairs, 1e3 * s.joint.before, 1e3 * s.joint.after,
      1e3 * s.joint.moved, run.captured.vertices.size());
  EXPECT_LE(s.median, 0.0015);
  EXPECT_LE(s.p95, 0.004);
  EXPECT_GE(s.coverage, 0.95);
  EXPECT_LE(s.seam, 0.003);
}

INSTANTIATE_TEST_SUITE_P(Objects, CaptureAccuracy,
                         testing::Values("box?motion=turned&frames=240", "cushion?motion=turned&frames=240",
                                         "figure?motion=turned&frames=240", "box?motion=circled&frames=240",
                                         "cushion?motion=circled&frames=240",
                                         "figure?motion=circled&frames=240"));

}  // namespace
}  // namespace pliant::test

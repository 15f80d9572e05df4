// The real plush toy: found without a start pose, followed while hands tilt and squash it.
#include <cmath>

#include "drivers/recording/recording.hpp"
#include "tests/integration/run.hpp"

namespace pliant::test {
namespace {

/// Looks at the first tracked frames.
struct Witness {
  std::int64_t first = -1;
  RigidTransform pose;
  void look(const TrackResult& result) {
    if (first >= 0 || result.state != TrackState::tracking) return;
    first = result.frame;
    pose = result.pose;
  }
};

TEST(RealRecording, ThePlushToyIsFoundAndFollowed) {
  const std::string folder = shared_data("real_plush_squirrel");
  if (folder.empty()) GTEST_SKIP() << "the shared recordings are not here";
  auto source = open_recording(folder);
  ASSERT_TRUE(source) << source.error().message;
  const ModelFile model = model_of(folder + "/model.ply");
  ASSERT_FALSE(model.view().empty());
  Witness witness;
  RunSettings settings = quiet_settings(**source);
  settings.witness = {[](void* context, const DepthFrame& /*frame*/, const TrackResult& result) {
                        static_cast<Witness*>(context)->look(result);
                      },
                      &witness};
  const auto end = run_pipeline(**source, model.view(), settings);
  ASSERT_TRUE(end) << end.error().message;
  const RunFigures& figures = end->figures;
  EXPECT_EQ(figures.frames(), 480);
  ASSERT_GE(witness.first, 0);
  EXPECT_LE(witness.first, 10);
  EXPECT_GE(static_cast<double>(figures.tracked), 0.9 * static_cast<double>(480 - witness.first));
  EXPECT_LE(figures.resident_bytes, 64'000'000U);
  // Where a person sees the toy in the first, still frames.
  EXPECT_LE((witness.pose.translation - Vector3(0.058, -0.040, 0.631)).norm(), 0.02);
}

}  // namespace
}  // namespace pliant::test

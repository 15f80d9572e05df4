// Simulated sequences made by another program than ours: the base region's pose against their truth.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "drivers/recording/recording.hpp"
#include "tests/integration/run.hpp"

namespace pliant::test {
namespace {

/// groundtruth.txt by stamp, µs.
std::map<std::int64_t, RigidTransform> read_truth(const std::string& file) {
  std::map<std::int64_t, RigidTransform> truth;
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    double stamp = 0;
    Quaternion q;
    RigidTransform pose;
    std::istringstream words(line);
    if (words >> stamp >> pose.translation.x() >> pose.translation.y() >> pose.translation.z() >> q.x >>
        q.y >> q.z >> q.w) {
      pose.rotation = rotation_from_quaternion(q);
      truth[std::llround(stamp * 1e6)] = pose;
    }
  }
  return truth;
}

/// What is asked of a sequence. Which part of a jointed object the tracker takes for its base is open, so
/// that only an object whose base is plain is compared with the truth of part 0.
struct Asked {
  const char* name;
  double tracked_share;  ///< of all frames from the first tracked one on
  bool compare;
};

class SharedSequence : public testing::TestWithParam<Asked> {};

TEST_P(SharedSequence, IsFollowed) {
  const std::string folder = shared_data(GetParam().name);
  if (folder.empty()) GTEST_SKIP() << "the shared sequences are not here";
  auto source = open_recording(folder);
  ASSERT_TRUE(source) << source.error().message;
  const ModelFile model = model_of(folder + "/model.ply");
  ASSERT_FALSE(model.view().empty());
  struct Errors {
    std::map<std::int64_t, RigidTransform> truth;
    Vector3 centre;
    std::vector<double> shift, angle;
    void look(const TrackResult& result) {
      if (result.state != TrackState::tracking || result.regions.empty() || result.regions.front().id != 0)
        return;
      const auto found = truth.find(result.utime);
      if (found == truth.end()) return;
      shift.push_back((result.pose * centre - found->second * centre).norm());
      angle.push_back(cos_angle(found->second.rotation.transpose() * result.pose.rotation));
    }
  } errors;
  errors.truth = read_truth(folder + "/groundtruth.txt");
  ASSERT_FALSE(errors.truth.empty());
  errors.centre = model.view().centre();
  RunSettings settings = quiet_settings(**source);
  settings.witness = {[](void* context, const DepthFrame& /*frame*/, const TrackResult& result) {
                        static_cast<Errors*>(context)->look(result);
                      },
                      &errors};
  const auto end = run_pipeline(**source, model.view(), settings);
  ASSERT_TRUE(end) << end.error().message;
  EXPECT_GE(end->figures.first_tracked, 0);
  EXPECT_LE(end->figures.first_tracked, 10);
  EXPECT_GE(
      static_cast<double>(end->figures.tracked),
      GetParam().tracked_share * static_cast<double>(end->figures.frames() - end->figures.first_tracked));
  if (!GetParam().compare) return;
  ASSERT_FALSE(errors.shift.empty());
  const auto middle = static_cast<std::ptrdiff_t>(errors.shift.size() / 2);
  std::nth_element(errors.shift.begin(), errors.shift.begin() + middle, errors.shift.end());
  std::nth_element(errors.angle.begin(), errors.angle.begin() + middle, errors.angle.end());
  EXPECT_LE(errors.shift[static_cast<std::size_t>(middle)], 0.004);                    // metres
  EXPECT_GE(errors.angle[static_cast<std::size_t>(middle)], std::cos(1.0 * 0.01745));  // one degree
}

// In the third the object is away for 17 frames, and as many are granted to find it again.
INSTANTIATE_TEST_SUITE_P(All, SharedSequence,
                         testing::Values(Asked{"sim_bunny_press", 0.99, true},
                                         Asked{"sim_homer_joints", 0.99, false},
                                         Asked{"sim_cushion_occlusion", 0.7, true},
                                         Asked{"sim_cheburashka_limbs", 0.99, false}),
                         [](const auto& about) { return std::string(about.param.name); });

}  // namespace
}  // namespace pliant::test

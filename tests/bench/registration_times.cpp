// Times of the stages of a registration: registration_times MODEL.ply SCENE MODEL_KEYPOINTS SCENE_KEYPOINTS
// [RUNS]
#include <cstdio>
#include <cstdlib>

#include "tests/accuracy/registration_runs.hpp"

int main(int argc, char** argv) {
  using namespace pliant;
  if (argc < 5) {
    std::fputs("usage: registration_times MODEL SCENE MODEL_KEYPOINTS SCENE_KEYPOINTS [RUNS]\n", stderr);
    return 2;
  }
  const BuiltFromFile model(argv[1]);
  const Result<Geometry> scene = read_geometry(argv[2]);
  if (!model.good || !scene) {
    std::fputs("registration_times: the model or the scene cannot be read\n", stderr);
    return 2;
  }
  RegistrationSettings settings;
  settings.model_keypoints = static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10));
  settings.scene_keypoints = static_cast<std::uint32_t>(std::strtoul(argv[4], nullptr, 10));
  const int runs = argc > 5 ? std::max(1, std::atoi(argv[5])) : 11;
  ReadyRegistration run(model.view, scene->vertices.size(), settings);
  if (run.fault != nullptr) {
    std::fprintf(stderr, "registration_times: %s\n", run.fault);
    return 2;
  }
  StageClock clock;
  run.registration.observe(clock.observer());
  std::vector<double> stages[kRegistrationStageCount], totals;
  RegistrationResult result;
  for (int k = 0; k < runs; ++k) {
    clock.begin();
    result = run.registration.register_cloud(scene->vertices);
    for (int s = 0; s < kRegistrationStageCount; ++s) stages[s].push_back(clock.ms[s]);
    totals.push_back(clock.total());
  }
  static constexpr const char* kNames[] = {"normals",  "keypoints", "descriptors", "matching",
                                           "grouping", "chain",     "deformed"};
  std::printf("keypoints %u x %u, %s, median of %d runs, thread time in ms\n", result.model_keypoints,
              result.scene_keypoints, describe(result.outcome), runs);
  for (int s = 0; s < kRegistrationStageCount; ++s) std::printf("%s %.2f  ", kNames[s], median_of(stages[s]));
  std::printf("total %.2f (least %.2f)\n", median_of(totals),
              *std::min_element(totals.begin(), totals.end()));
  return 0;
}

#include "tests/integration/run.hpp"

#include <filesystem>

#include "drivers/model_files/model_builder.hpp"

namespace pliant::test {

RunSettings quiet_settings(const DepthSource& source) {
  RunSettings settings;
  settings.sensor = source.sensor();
  settings.lcm_url = "none";
  settings.hash = true;
  return settings;
}

void run_simulated(const std::string& uri, SimulatedRun& run) {
  auto simulated = open_simulated(uri);
  ASSERT_TRUE(simulated) << simulated.error().message;
  auto built = build_model((*simulated)->mesh(), {});
  ASSERT_TRUE(built) << built.error().message;
  auto model = ModelFile::from_image(std::move(built->image), uri);
  ASSERT_TRUE(model) << model.error().message;
  run.model = std::move(*model);
  run.source = std::make_unique<demo::RememberingSource>(std::move(*simulated));
  run.check = std::make_unique<demo::TruthCheck>(run.model.view(), *run.source);

  RunSettings settings = quiet_settings(*run.source);
  settings.witness = {[](void* check, const DepthFrame& /*frame*/, const TrackResult& result) {
                        static_cast<demo::TruthCheck*>(check)->look(result);
                      },
                      run.check.get()};
  auto end = run_pipeline(*run.source, run.model.view(), settings);
  ASSERT_TRUE(end) << end.error().message;
  run.end = std::move(*end);
}

ModelFile model_of(const std::string& mesh) {
  const auto geometry = read_geometry(mesh);
  if (!geometry) {
    ADD_FAILURE() << geometry.error().message;
    return {};
  }
  auto built = build_model(*geometry, {});
  if (!built) {
    ADD_FAILURE() << built.error().message;
    return {};
  }
  auto model = ModelFile::from_image(std::move(built->image), mesh);
  if (!model) {
    ADD_FAILURE() << model.error().message;
    return {};
  }
  return std::move(*model);
}

std::string shared_data(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(PLIANT_SHARED_DATA) / name;
  return std::filesystem::is_directory(folder) ? folder.string() : std::string();
}

}  // namespace pliant::test

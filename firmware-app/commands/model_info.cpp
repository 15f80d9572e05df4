// pliant model info: what is in a model file, and what tracking it takes.
#include <fmt/format.h>

#include <memory>

#include "core/tracker.hpp"
#include "drivers/model_files/describe_model.hpp"
#include "drivers/model_files/model_file.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/expected_detection.hpp"
#include "firmware-app/commands/memory_plan.hpp"

namespace pliant {

namespace {

int info(const std::string& path) {
  const Result<ModelFile> file = ModelFile::open(path);
  if (!file) return report(file.error());
  std::string text = describe_model(file->view());
  constexpr Intrinsics kCamera{320, 240, 288, 288, 160, 120, 1000};
  if (const Outcome tracked = check_tracker(*file, kCamera, {}, {}); !tracked) {
    text += fmt::format("tracking: not possible, {}\n", tracked.error().message);
    return print(text) ? kExitDone : kExitFailed;
  }
  LiveLine line;
  line.show("looking for the model in simulated pictures of it");
  const ExpectedDetection expected = expect_detection(file->view());
  line.clear();
  text += fmt::format("coverage: {:.0f} % of what can be seen from around\n", 100 * expected.coverage);
  text +=
      expected.views > 0
          ? fmt::format(
                "expected detection: {} of {} simulated views, {:.1f} m away, from where its outside shows\n",
                expected.found, expected.views, expected.distance)
          : std::string("expected detection: none, it shows its outside to no side\n");
  text += "memory to track it, MB:\n";
  for (const auto& [width, height] : {std::pair{320, 240}, std::pair{640, 480}}) {
    const Intrinsics camera{width, height, width * 0.9, width * 0.9, width * 0.5, height * 0.5, 1000};
    text += fmt::format("  {}x{}: {}\n", width, height, describe(plan_memory(*file, camera, {})));
  }
  return print(text) ? kExitDone : kExitFailed;
}

}  // namespace

void add_model_info(CLI::App& model, Work& work) {
  CLI::App* app = model.add_subcommand("info", "Tell what is in a model file and the memory that it takes");
  auto path = std::make_shared<std::string>();
  app->add_option("FILE", *path, "Model file")->required();
  app->callback([path, &work] { work = [path] { return info(*path); }; });
}

}  // namespace pliant

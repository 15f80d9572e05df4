// pliant register: one-shot registration of a cloud or a depth picture, as in the paper; no start pose.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>
#include <vector>

#include "core/registration/cloud_registration.hpp"
#include "drivers/geometry_files/points_ply.hpp"
#include "drivers/images/png.hpp"
#include "drivers/model_files/model_file.hpp"
#include "drivers/recording/camera_file.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/commands/option_checks.hpp"
#include "firmware-app/commands/registration_report.hpp"
#include "firmware-app/commands/scene.hpp"
#include "firmware-app/pipeline/memory_block.hpp"

namespace pliant {

namespace {

struct RegisterOptions {
  std::string model, scene, camera, output, report;
  std::vector<std::uint32_t> keypoints;
  int max_regions = 8, max_instances = 1, threads = 1;
  std::vector<double> viewpoint;
  bool no_warp = false, no_constraints = false;
};

/// Of a viewpoint, metres: that of no scene lies farther, and its square is a number yet.
constexpr double kFarthest = 1e7;

/// Threads that share work; none of them lasts longer than a task.
void run_on_threads(void* /*context*/, std::size_t pieces, WorkSharer::Piece work, void* task) {
  std::vector<std::thread> threads;
  threads.reserve(pieces - 1);
  for (std::size_t piece = 1; piece < pieces; ++piece) threads.emplace_back([=] { work(task, piece); });
  work(task, 0);
  for (std::thread& thread : threads) thread.join();
}

RegistrationSettings settings_of(const RegisterOptions& options) {
  RegistrationSettings settings;
  if (options.keypoints.size() == 2) {
    settings.model_keypoints = options.keypoints[0];
    settings.scene_keypoints = options.keypoints[1];
  }
  settings.max_regions = static_cast<std::uint32_t>(options.max_regions);
  settings.max_instances = static_cast<std::uint32_t>(options.max_instances);
  settings.has_viewpoint = options.viewpoint.size() == 3;
  if (settings.has_viewpoint)
    settings.viewpoint = Vector3(options.viewpoint[0], options.viewpoint[1], options.viewpoint[2]);
  settings.warp = !options.no_warp;
  settings.constraints = !options.no_constraints;
  settings.workers = static_cast<std::uint32_t>(options.threads);
  settings.sharer.run = &run_on_threads;
  return settings;
}

/// "result.ply" for the best instance, "result.1.ply", "result.2.ply" for further ones.
std::string instance_path(const std::string& output, std::size_t instance) {
  if (instance == 0) return output;
  std::filesystem::path path(output);
  const std::string extension = path.extension().string();
  return path.replace_extension(fmt::format(".{}{}", instance, extension)).string();
}

/// Whether an earlier registration wrote it: what else has such a name is not ours to remove.
bool is_instance(const std::string& path) {
  std::error_code fault;
  if (!std::filesystem::is_regular_file(path, fault)) return false;
  std::array<char, 256> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size() - 1);
  const std::string_view text(head.data());
  return text.starts_with("ply\n") && text.find("property float rest_x\n") != std::string_view::npos;
}

/// Instances of an earlier run, which would pass for ones of this.
Outcome remove_older(const std::string& output, std::size_t first) {
  for (std::size_t i = first; i < CloudRegistration::kMostInstances; ++i) {
    const std::string path = instance_path(output, i);
    std::error_code fault;
    if (is_instance(path) && !std::filesystem::remove(path, fault) && fault)
      return Error{ErrorKind::write,
                   fmt::format("{}: is of an earlier run and cannot be removed: {}", path, fault.message())};
  }
  return success();
}

Outcome write_instances(const RegisterOptions& options, const ModelView& model, const Scene& scene,
                        const RegistrationResult& result) {
  PointsPlyWriter writer(model.positions());
  std::vector<std::int32_t> matches;
  for (std::size_t i = 0; i < result.instances.size(); ++i) {
    const InstanceResult& instance = result.instances[i];
    matches.assign(instance.matches.begin(), instance.matches.end());
    for (std::int32_t& match : matches) match = scene.index_in_file(match);
    if (Outcome written = writer.write(instance_path(options.output, i).c_str(), instance.positions,
                                       instance.labels, matches, instance.residuals);
        !written)
      return written;
  }
  return remove_older(options.output, result.instances.size());
}

/// The result's names are all claimed: those of further instances too, which may be removed.
Outcome files_apart(const RegisterOptions& options) {
  NamedFiles files;
  files.reads("--model", options.model)
      .reads("--scene", options.scene)
      .reads("--camera", options.camera)
      .writes("--report", options.report);
  for (std::size_t i = 0; i < CloudRegistration::kMostInstances; ++i)
    files.writes("--output", instance_path(options.output, i));
  return files.apart();
}

int register_scene(const RegisterOptions& options) {
  if (const Outcome apart = files_apart(options); !apart) return report(apart.error());
  const Result<ModelFile> model = ModelFile::open(options.model);
  if (!model) return report(model.error());
  const Result<Scene> scene = read_scene(options.scene, options.camera);
  if (!scene) return report(scene.error());

  const RegistrationSettings settings = settings_of(options);
  const std::size_t points = scene->point_count();
  Result<MemoryBlock> block =
      MemoryBlock::allocate(CloudRegistration::workspace_bytes(model->view(), points, settings));
  if (!block) return report(block.error());
  CloudRegistration registration;
  if (const char* fault = registration.start(model->view(), points, settings, block->bytes());
      fault != nullptr)
    return report({ErrorKind::bad_input, fmt::format("the registration cannot start: {}", fault)});

  LiveLine line;
  RegistrationTimes times;
  registration.observe(times.observer([&line](const char* stage) { line.show(stage); }));
  times.begin();
  const RegistrationResult& result =
      scene->is_picture
          ? registration.register_depth(scene->frame(), scene->camera.intrinsics, scene->camera.sensor)
          : registration.register_cloud(scene->cloud.vertices);
  times.end();
  line.clear();

  const bool found = result.outcome == RegistrationOutcome::found && !result.instances.empty();
  if (found)
    if (const Outcome written = write_instances(options, model->view(), *scene, result); !written)
      return report(written.error());
  if (!options.report.empty()) {
    const Outcome written = write_registration_report(options.report, result, times);
    if (!written) return report(written.error());
  }
  if (found) return print(registration_table(result, times)) ? kExitDone : kExitFailed;
  print_warning(fmt::format("{}: {}", options.scene, registration_fault(result)));
  return result.outcome == RegistrationOutcome::no_points ||
                 result.outcome == RegistrationOutcome::too_many_points
             ? kExitBadInput
             : kExitNotFound;
}

}  // namespace

void add_register(CLI::App& program, Work& work) {
  CLI::App* app = program.add_subcommand("register", "Find a model in one cloud or depth picture");
  auto options = std::make_shared<RegisterOptions>();
  app->add_option("--model", options->model, "Model file")->required()->type_name("FILE");
  app->add_option("--scene", options->scene, "Cloud (PLY, PCD) or 16-bit depth picture (PNG)")
      ->required()
      ->type_name("FILE");
  app->add_option("--camera", options->camera, "camera.toml of a depth picture")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("-o,--output", options->output,
                  "Where every model point is, PLY; further instances go to OUT.1.ply, OUT.2.ply, ...; "
                  "those that an earlier run left there are removed")
      ->required()
      ->check(names_a_file())
      ->type_name("OUT.ply");
  app->add_option(
         "--report", options->report,
         "Instances, regions, transforms and times, JSON; work that belongs to the model and could be "
         "done beforehand is kept apart")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--keypoints", options->keypoints, "Keypoints of model and scene")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(32, 65535).description(""))
      ->type_name("M,S");
  app->add_option("--max-regions", options->max_regions, "Rigid regions of one instance, 1 to 8")
      ->check(CLI::Range(1, limits::kMaxRegions).description(""))
      ->type_name("N");
  app->add_option("--max-instances", options->max_instances, "Instances of the model to look for, 1 to 32")
      ->check(CLI::Range(1, static_cast<int>(CloudRegistration::kMostInstances)).description(""))
      ->type_name("N");
  app->add_option(
         "--viewpoint", options->viewpoint,
         "Where the sensor stood, scene frame, metres; left out: normals are made consistent by themselves")
      ->delimiter(',')
      ->expected(3)
      ->check(number_within(-kFarthest, kFarthest))
      ->type_name("x,y,z");
  app->add_option("--threads", options->threads,
                  "Threads that share descriptors and matches of a cloud, 1 to 16; the result is the same")
      ->check(CLI::Range(1, static_cast<int>(kMostWorkers)).description(""))
      ->type_name("N");
  app->add_flag("--no-warp", options->no_warp,
                "Deformed points lie where the nearest free scene point lies, as in the paper");
  app->add_flag("--no-constraints", options->no_constraints,
                "A chain of regions may tear the object apart at its joints, as in the paper");
  app->callback([options, &work] { work = [options] { return register_scene(*options); }; });
}

}  // namespace pliant

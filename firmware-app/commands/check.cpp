// pliant check: is a config valid, and what memory and time follow from it.
#include <fmt/format.h>

#include <memory>

#include "drivers/model_files/describe_model.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/inputs.hpp"
#include "firmware-app/commands/memory_plan.hpp"
#include "firmware-app/commands/run_inputs.hpp"
#include "firmware-app/config/config.hpp"
#include "firmware-app/config/sensor_file.hpp"

namespace pliant {

namespace {

/// Everything that the config names, opened.
struct Checked {
  TrackSettings track;
  SensorFile sensor;
  Intrinsics camera;
  std::string camera_origin;
  std::string device;  ///< why the source's device cannot be used now; no fault of the config
  ModelFile model;
  bool has_model = false;
};

Result<Checked> open_all(const Config& config) {
  Checked all;
  all.camera_origin = "no source or sensor given";
  SourceOptions options;
  if (!config.sensor.description.empty()) {
    Result<SensorFile> sensor = read_sensor(config.sensor.description);
    if (!sensor) return sensor.error();
    all.sensor = *sensor;
    options.sensor = *sensor;
    all.camera_origin = "from the sensor's description";
  }
  all.track.max_regions = config.track.max_regions;
  all.track.material = config.track.material.value_or(TrackSettings::kAsInModel);
  SensorDescription readings = all.sensor.noise;
  all.camera = all.sensor.intrinsics();
  if (!config.source.empty()) {
    const Result<OpenSource> source = open_source(config.source, options);
    if (source) {
      all.camera = source->source->intrinsics();
      readings = sensor_of(*source->source, options);
      all.camera_origin = "from the source";
    } else if (source.error().kind == ErrorKind::bad_input) {
      return source.error();
    } else {
      // Not plugged in yet, or in use by the service.
      all.device = source.error().message;
      if (!options.sensor) all.camera_origin = "that of a Structure Sensor, for want of the device";
    }
  }
  if (!config.model.empty() || brings_own_model(config.source)) {
    Result<ModelFile> model = load_model(config.model, config.source);
    if (!model) return model.error();
    if (const Outcome tracked = check_tracker(*model, all.camera, readings, all.track); !tracked)
      return at_key(config, config.model.empty() ? "source" : "model", tracked.error());
    all.model = std::move(*model);
    all.has_model = true;
  }
  if (const Outcome lcm = check_lcm(config); !lcm) return lcm.error();
  if (const Outcome bind = check_bind(config.view.bind); !bind)
    return at_key(config, "view.bind", bind.error());
  return all;
}

int check(const std::string& path) {
  const Result<Config> config = read_config(path);
  if (!config) return report(config.error());
  RunOptions run;
  run.config = path;
  if (const Outcome apart = check_files(run, *config); !apart) return report(apart.error());
  const Result<Checked> all = open_all(*config);
  if (!all) return report(all.error());

  std::string text = describe_config(*config) + "\n";
  if (all->has_model) text += describe_model(all->model.view());
  text += fmt::format("camera: {}x{}, {}\n", all->camera.width, all->camera.height, all->camera_origin);
  if (all->has_model) {
    text += fmt::format("memory, MB: {}\n", describe(plan_memory(all->model, all->camera, all->track)));
  } else {
    text += "memory: follows from the model; none is given\n";
  }
  const double period = 1000 / all->sensor.mode.rate;
  text += fmt::format("time: {:g} ms for a frame, one comes every {:.1f} ms{}\n", config->track.budget_ms,
                      period, config->track.budget_ms > period ? "; frames will be dropped" : "");
  if (!all->device.empty()) text += fmt::format("device: cannot be used now: {}\n", all->device);
  text += fmt::format("{} is valid\n", path);
  return print(text) ? kExitDone : kExitFailed;
}

}  // namespace

void add_check(CLI::App& program, Work& work) {
  CLI::App* app = program.add_subcommand("check", "Validate a config; show the memory and time that follow");
  auto path = std::make_shared<std::string>();
  app->add_option("--config", *path, "Config file (TOML)")->required()->type_name("FILE");
  app->callback([path, &work] { work = [path] { return check(*path); }; });
}

}  // namespace pliant

// pliant run: the tracker.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "core/simd/cpu.hpp"
#include "drivers/geometry_files/atomic_file.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/inputs.hpp"
#include "firmware-app/config/config.hpp"
#include "firmware-app/config/sensor_file.hpp"
#include "firmware-app/outputs/run_report.hpp"
#include "firmware-app/pipeline/run_pipeline.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant {

namespace {

struct RunOptions {
  std::string config;
  std::optional<std::string> model, source, lcm_url, sensor;
  bool publish_depth = false;
  std::string trajectory, points, stats;
  std::int64_t frames = -1;
  std::optional<std::string> pace;
  std::optional<int> threads;
  Kernels kernels = Kernels::automatic;
};

const std::map<std::string, Kernels> kKernelNames = {{"auto", Kernels::automatic},
                                                     {"scalar", Kernels::scalar},
                                                     {"sse", Kernels::sse},
                                                     {"avx2", Kernels::avx2},
                                                     {"neon", Kernels::neon}};

/// The config file, with the command line's values put over it.
Result<Config> merged_config(const RunOptions& options) {
  Config config;
  if (!options.config.empty()) {
    Result<Config> read = read_config(options.config);
    if (!read) return read.error();
    config = *read;
  }
  if (options.model) config.model = *options.model;
  if (options.source) config.source = *options.source;
  if (options.lcm_url) config.lcm.url = *options.lcm_url;
  if (options.sensor) config.sensor.description = *options.sensor;
  if (options.publish_depth) config.lcm.publish_depth = true;
  if (options.threads) config.run.threads = *options.threads;
  if (config.source.empty())
    return Error{ErrorKind::bad_input,
                 "no source: give --source URI or 'source' in the config, for example --source " +
                     std::string(kSourceExample)};
  return config;
}

/// -1 where unknown.
std::int64_t frames_to_come(std::int64_t in_source, std::int64_t limit) {
  if (in_source < 0 || limit < 0) return std::max(in_source, limit);
  return std::min(in_source, limit);
}

/// All kernels give the same bytes, so one that this processor has not is no error.
void warn_of_missing_kernels(Kernels kernels) {
  if (kernels != Kernels::automatic && kernels != Kernels::scalar && simd_body(kernels) == SimdBody::scalar)
    print_warning("this processor has not the kernels asked for; the scalar ones run");
}

int finish(const RunOptions& options, const RunEnd& end, AtomicFile& stats) {
  const RunFigures& figures = end.figures;
  bool failed = end.files_failed;
  if (!options.stats.empty()) {
    const std::string json = stats_json(figures);
    Outcome written = stats.write(std::as_bytes(std::span(json)));
    if (written) written = stats.commit(false);
    if (!written) {
      static_cast<void>(report(written.error()));
      failed = true;
    }
  }
  if (!print(closing_table(figures))) failed = true;
  if (end.device_lost) return report({ErrorKind::device, end.fault});
  if (failed) return kExitFailed;
  if (end.stopped) return kExitDone;
  if (figures.frames() == 0)
    return report({ErrorKind::bad_input,
                   end.fault.empty() ? "the source has no frame" : "no frame is usable: " + end.fault});
  return figures.last_state == TrackState::tracking ? kExitDone : kExitNotFound;
}

int run(const RunOptions& options) {
  const StopSignal stop;
  const Result<Config> config = merged_config(options);
  if (!config) return report(config.error());
  SourceOptions source_options;
  source_options.patience = config->sensor.patience_s;
  if (!config->sensor.description.empty()) {
    const Result<SensorFile> sensor = read_sensor(config->sensor.description);
    if (!sensor) return report(sensor.error());
    source_options.sensor = *sensor;
  }
  Result<OpenSource> source = open_source(config->source, source_options);
  if (!source) return report(source.error());
  if (config->model.empty() && !brings_own_model(config->source))
    return report({ErrorKind::bad_input,
                   "no model: give --model FILE or 'model' in the config; 'pliant model build' makes one"});
  Result<ModelFile> model = load_model(config->model, config->source);
  if (!model) return report(model.error());

  warn_of_missing_kernels(options.kernels);
  RunSettings settings;
  settings.source_name = config->source;
  settings.version = PLIANT_VERSION;
  settings.sensor = source->source->sensor();
  if (source_options.sensor) settings.sensor = source_options.sensor->noise;
  settings.track.max_regions = config->track.max_regions;
  settings.track.material = config->track.material;
  settings.track.kernels = options.kernels;
  settings.lcm_url = config->lcm.url;
  settings.lcm_prefix = config->lcm.prefix;
  settings.publish_depth = config->lcm.publish_depth;
  settings.realtime = options.pace.value_or(source->source->live() ? "realtime" : "fast") == "realtime";
  settings.frame_limit = options.frames;
  settings.budget_ms = config->track.budget_ms;
  settings.priority = config->run.priority;
  settings.affinity = config->run.affinity;
  settings.files = {.trajectory = options.trajectory, .points = options.points, .wait_for_disk = true};
  settings.hash = !options.stats.empty();
  LiveLine line;
  const std::int64_t frame_count = frames_to_come(source->source->frame_count(), options.frames);
  if (line.active())
    settings.progress = [&](const LiveFigures& live) { line.show(status_line(live, frame_count)); };
  settings.warn = [&](const std::string& message) {
    line.clear();
    print_warning(message);
  };

  // Opened before the run, so that a run of hours does not end without its figures.
  AtomicFile stats;
  if (!options.stats.empty())
    if (Outcome opened = stats.open(options.stats.c_str()); !opened) return report(opened.error());

  const Result<RunEnd> end = run_pipeline(*source->source, model->view(), settings);
  line.clear();
  if (!end) return report(end.error());
  return finish(options, *end, stats);
}

}  // namespace

void add_run(CLI::App& program, Work& work) {
  CLI::App* app = program.add_subcommand("run", "Track a model in the frames of a source");
  auto options = std::make_shared<RunOptions>();
  app->add_option("--config", options->config, "Config file (TOML); the options below win over it")
      ->type_name("FILE");
  app->add_option("--model", options->model, "Model file; a simulated source brings its own")
      ->type_name("FILE");
  app->add_option("--source", options->source, kSourceHelp)->type_name("URI");
  app->add_option("--sensor", options->sensor,
                  "Sensor description (TOML): mode, camera and noise of a device")
      ->type_name("FILE");
  app->add_flag("--publish-depth", options->publish_depth, "Publish the depth frames too");
  app->add_option("--trajectory", options->trajectory, "Write the base region's path, TUM format")
      ->type_name("FILE");
  app->add_option("--points", options->points, "Write where every point is, a PLY file per tracked frame")
      ->type_name("DIR");
  app->add_option("--stats", options->stats, "Write the run's figures, JSON")->type_name("FILE");
  app->add_option("--lcm-url", options->lcm_url, "LCM network to publish on, 'none' to publish nothing")
      ->type_name("URL");
  app->add_option("--frames", options->frames, "Take this many frames from the source")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 62).description(""))
      ->type_name("N");
  app->add_option("--pace", options->pace,
                  "realtime: frames come when their stamps say, the newest wins; fast: every frame, as fast "
                  "as can be. Files are fast by default, live sources have their own pace")
      ->check(CLI::IsMember({"realtime", "fast"}).description(""))
      ->type_name("realtime|fast");
  app->add_option("--threads", options->threads, "Threads that share the work of one frame, 1 to 64")
      ->check(CLI::Range(1, 64).description(""))
      ->type_name("N");
  app->add_option("--kernels", options->kernels, "Instruction set of the kernels; all give the same bytes")
      ->transform(CLI::CheckedTransformer(kKernelNames).description(""))
      ->type_name("auto|scalar|sse|avx2|neon");
  app->callback([options, &work] { work = [options] { return run(*options); }; });
}

}  // namespace pliant

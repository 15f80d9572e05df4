#include "firmware-app/commands/run_inputs.hpp"

#include <utility>

#include "drivers/lcm/publisher.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/config/sensor_file.hpp"

namespace pliant {

Result<Config> merged_config(const RunOptions& options) {
  Config config;
  if (!options.config.empty()) {
    Result<Config> read = read_config(options.config);
    if (!read) return read.error();
    config = *read;
  }
  if (options.model) config.model = *options.model;
  if (options.source) config.source = *options.source;
  if (options.lcm_url) {
    config.lcm.url = *options.lcm_url;
    config.places.erase("lcm.url");
  }
  if (options.sensor) config.sensor.description = *options.sensor;
  if (options.publish_depth) config.lcm.publish_depth = true;
  if (options.threads) config.run.threads = *options.threads;
  if (config.source.empty())
    return Error{ErrorKind::bad_input,
                 "no source: give --source URI or 'source' in the config, for example --source " +
                     std::string(kSourceExample)};
  return config;
}

namespace {

bool ask_the_same(const std::optional<SensorFile>& a, const std::optional<SensorFile>& b) {
  return a && b ? a->asks_the_same_as(*b) : a.has_value() == b.has_value();
}

RunSettings settings_of(const RunOptions& options, const Config& config, const DepthSource& source) {
  RunSettings settings;
  settings.source_name = config.source;
  settings.version = PLIANT_VERSION;
  settings.track.max_regions = config.track.max_regions;
  settings.track.material = config.track.material.value_or(TrackSettings::kAsInModel);
  settings.track.kernels = options.kernels;
  settings.lcm_url = config.lcm.url;
  settings.lcm_prefix = config.lcm.prefix;
  settings.publish_depth = config.lcm.publish_depth;
  settings.realtime = options.pace.value_or(source.live() ? "realtime" : "fast") == "realtime";
  settings.frame_limit = options.frames;
  settings.budget_ms = config.track.budget_ms;
  settings.priority = config.run.priority;
  settings.affinity = config.run.affinity;
  settings.lock_memory = config.run.lock_memory;
  settings.files = {.trajectory = options.trajectory, .points = options.points, .wait_for_disk = true};
  settings.hash = !options.stats.empty();
  return settings;
}

}  // namespace

Outcome check_files(const RunOptions& options, const Config& config) {
  return NamedFiles()
      .reads("--config", options.config)
      .reads(option_or_key(options.model.has_value(), "--model", "model"), config.model)
      .reads(option_or_key(options.sensor.has_value(), "--sensor", "sensor.description"),
             config.sensor.description)
      .reads_source(option_or_key(options.source.has_value(), "--source", "source"), config.source)
      .writes("--trajectory", options.trajectory)
      .writes("--points", options.points)
      .writes("--stats", options.stats)
      .uses_log(option_or_key(options.lcm_url.has_value(), "--lcm-url", "lcm.url"), config.lcm.url)
      .apart();
}

Outcome check_lcm(const Config& config) {
  if (config.lcm.url != "none")
    if (const Outcome url = LcmPublisher::check_url(config.lcm.url); !url)
      return at_key(config, "lcm.url", url.error());
  if (const Outcome prefix = check_channel_prefix(config.lcm.prefix); !prefix)
    return at_key(config, "lcm.prefix", prefix.error());
  return success();
}

Result<RunInputs> open_run_inputs(const RunOptions& options, const Config& config, const RunInputs* before) {
  if (Outcome apart = check_files(options, config); !apart) return apart.error();
  RunInputs inputs;
  inputs.config = config;
  // Before anything is opened, so that a wrong word costs no file what it holds.
  if (const Outcome lcm = check_lcm(config); !lcm) return lcm.error();
  SourceOptions source_options;
  source_options.patience = config.sensor.patience_s;
  if (!config.sensor.description.empty()) {
    const Result<SensorFile> sensor = read_sensor(config.sensor.description);
    if (!sensor) return sensor.error();
    source_options.sensor = *sensor;
  }
  inputs.sensor = source_options.sensor;
  const bool same_source = before != nullptr && before->config.source == config.source &&
                           ask_the_same(before->sensor, inputs.sensor) &&
                           before->config.sensor.patience_s == config.sensor.patience_s;
  if (same_source) {
    inputs.source = before->source;
  } else {
    Result<OpenSource> source = open_source(config.source, source_options);
    if (!source) return source.error();
    inputs.source = std::make_shared<OpenSource>(std::move(*source));
  }
  if (config.model.empty() && !brings_own_model(config.source))
    return Error{ErrorKind::bad_input,
                 "no model: give --model FILE or 'model' in the config; 'pliant model build' makes one"};
  Result<ModelFile> model = load_model(config.model, config.source);
  if (!model) return model.error();
  const bool same_model =
      before != nullptr && before->model->view().header().checksum == model->view().header().checksum;
  inputs.model = same_model ? before->model : std::make_shared<ModelFile>(std::move(*model));
  inputs.settings = settings_of(options, config, *inputs.source->source);
  inputs.settings.sensor = sensor_of(*inputs.source->source, source_options);
  return inputs;
}

}  // namespace pliant

// What a run is made of: the merged configuration, and everything that it names, opened and checked.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "firmware-app/commands/inputs.hpp"
#include "firmware-app/config/config.hpp"
#include "firmware-app/pipeline/run_pipeline.hpp"

namespace pliant {

/// The command line of `pliant run`.
struct RunOptions {
  std::string config;
  std::optional<std::string> model, source, lcm_url, sensor;
  bool publish_depth = false;
  std::string trajectory, points, stats;
  std::int64_t frames = -1;
  std::optional<std::string> pace;
  std::optional<int> threads;
  Kernels kernels = Kernels::automatic;

  [[nodiscard]] bool writes_files() const { return !trajectory.empty() || !points.empty() || !stats.empty(); }
};

struct RunInputs {
  Config config;
  std::optional<SensorFile> sensor;  ///< what the config's description says; empty where it names none
  std::shared_ptr<OpenSource> source;
  std::shared_ptr<ModelFile> model;
  RunSettings settings;
};

/// The config file with the command line's values put over it. ErrorKind::bad_input names file, line and
/// column.
[[nodiscard]] Result<Config> merged_config(const RunOptions& options);

/// Whether no file that a run writes is one that it reads, or writes for another option.
[[nodiscard]] Outcome check_files(const RunOptions& options, const Config& config);

/// Whether a run could publish as `config` says, as far as that shows without doing it.
[[nodiscard]] Outcome check_lcm(const Config& config);

/// Opens and checks all that `config` names. What `before` (may be null) has open already and the config
/// names again is taken over.
[[nodiscard]] Result<RunInputs> open_run_inputs(const RunOptions& options, const Config& config,
                                                const RunInputs* before);

}  // namespace pliant

// The program's configuration. A member's name is its key in the TOML file.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"
#include "firmware-app/config/settings_table.hpp"

namespace pliant {

/// Defaults, units and ranges stand once, in the table in config.cpp, and are shown by `pliant check`.
struct Config {
  std::string model;
  std::string source;
  struct Lcm {
    std::string url;
    std::string prefix = "PLIANT";
    bool publish_depth = false;
  } lcm;
  struct Track {
    double budget_ms = 33;
    int max_regions = 8;
    std::optional<double> material;  ///< none: as the model says
  } track;
  struct Sensor {
    std::string description;
    double patience_s = 60;
  } sensor;
  struct Run {
    int threads = 1;
    int priority = 0;
    std::vector<int> affinity;
    bool lock_memory = false;
  } run;
  struct View {
    std::string bind = "127.0.0.1";
    int port = 8080;
  } view;
  SettingPlaces places;  ///< of the keys that a file sets
};

/// Reads TOML text into `config`; keys that are not there keep what `config` holds. An error names `name`,
/// line and column and says what is allowed.
[[nodiscard]] Outcome parse_config(std::string_view text, std::string_view name, Config& config);

/// Reads a file. Paths in it (model, sensor description) are taken relative to its folder.
[[nodiscard]] Result<Config> read_config(const std::string& path);

/// `error` about a key's value, with the place in the file where that stands.
[[nodiscard]] Error at_key(const Config& config, std::string_view key, const Error& error);

/// Why `[view] bind` can be no address to listen on: a number that is none, or a name that no host can have.
/// Whether it is this machine's shows when it is listened on.
[[nodiscard]] Outcome check_bind(const std::string& address);

/// The keys whose values differ, "track.budget_ms, lcm.prefix"; empty when none does.
[[nodiscard]] std::string changed_keys(const Config& before, const Config& after);

/// One line a key: name, value, range and meaning.
[[nodiscard]] std::string describe_config(const Config& config);

}  // namespace pliant

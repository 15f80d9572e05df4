#include "firmware-app/config/config.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "core/limits.hpp"
#include "drivers/recording/text_file.hpp"
#include "firmware-app/config/settings_table.hpp"

namespace pliant {

namespace {

/// Every key of pliant.toml.
std::vector<Setting> config_settings(Config& c) {
  return {
      {"", "model", &c.model, 0, 4096, "", "the model file to track"},
      {"", "source", &c.source, 0, 4096, "", "where depth frames come from"},
      {"lcm", "url", &c.lcm.url, 0, 1024, "",
       "LCM network, \"none\" to publish nothing, \"\" for the default"},
      {"lcm", "prefix", &c.lcm.prefix, 1, 54, "", "first word of the channels' names"},
      {"lcm", "publish_depth", &c.lcm.publish_depth, 0, 1, "", "publish the depth frames too"},
      {"track", "budget_ms", &c.track.budget_ms, 1, 1000, "ms", "time that one frame may take"},
      {"track", "max_regions", &c.track.max_regions, 1, limits::kMaxRegions, "",
       "rigid parts followed at once"},
      {"track", "material", &c.track.material, 0, 1, "",
       "how easily the object stretches, 0 stiff, 1 soft; left out: as the model says"},
      {"sensor", "description", &c.sensor.description, 0, 4096, "", "file that describes the sensor"},
      {"sensor", "patience_s", &c.sensor.patience_s, 0, 1e7, "s",
       "how long a device may be gone before the run gives up"},
      {"run", "threads", &c.run.threads, 1, 64, "", "threads that share the work of one frame"},
      {"run", "priority", &c.run.priority, 0, 99, "", "real-time priority of tracking, 0 for none"},
      {"run", "affinity", &c.run.affinity, 0, 1023, "", "processors that tracking may use, [] for all"},
      {"run", "lock_memory", &c.run.lock_memory, 0, 1, "", "keep all of the program in memory"},
      {"view", "bind", &c.view.bind, 1, 255, "", "address that the web viewer listens on"},
      {"view", "port", &c.view.port, 1, 65535, "", "port that the web viewer listens on"},
  };
}

/// A path as written in a file in `folder`, seen from the working folder.
void make_relative_to(const std::filesystem::path& folder, std::string& path) {
  if (!path.empty() && std::filesystem::path(path).is_relative()) path = (folder / path).string();
}

}  // namespace

Outcome parse_config(std::string_view text, std::string_view name, Config& config) {
  Config candidate = config;
  const std::vector<Setting> settings = config_settings(candidate);
  if (Outcome parsed = parse_settings(text, name, settings, &candidate.places); !parsed) return parsed;
  config = candidate;
  return success();
}

Result<Config> read_config(const std::string& path) {
  const Result<std::string> text = read_text_file(path, kMaxSettingsText);
  if (!text) return Error{ErrorKind::bad_input, "cannot read the config file " + text.error().message};
  Config config;
  if (Outcome parsed = parse_config(*text, path, config); !parsed) return parsed.error();
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  make_relative_to(folder, config.model);
  make_relative_to(folder, config.sensor.description);
  for (const std::string_view scheme : {"recording:", "oni:", "lcmlog:"})
    if (config.source.starts_with(scheme)) {
      std::string file = config.source.substr(scheme.size());
      make_relative_to(folder, file);
      config.source = std::string(scheme) + file;
    }
  constexpr std::string_view kLogFile = "file://";
  if (config.lcm.url.starts_with(kLogFile)) {
    const std::size_t options = std::min(config.lcm.url.find('?'), config.lcm.url.size());
    std::string file = config.lcm.url.substr(kLogFile.size(), options - kLogFile.size());
    make_relative_to(folder, file);
    config.lcm.url = std::string(kLogFile) + file + config.lcm.url.substr(options);
  }
  return config;
}

Error at_key(const Config& config, std::string_view key, const Error& error) {
  const auto place = config.places.find(key);
  if (place == config.places.end()) return error;
  return {error.kind, fmt::format("{}: {}: {}", place->second, key, error.message)};
}

Outcome check_bind(const std::string& address) {
  constexpr std::string_view kNumbers = "0123456789.";
  constexpr std::string_view kNames = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._";
  std::array<std::byte, sizeof(in6_addr)> ignored{};
  const bool number = address.find_first_not_of(kNumbers) == std::string::npos;
  const bool known = address.find(':') != std::string::npos
                         ? inet_pton(AF_INET6, address.c_str(), ignored.data()) == 1
                     : number ? inet_pton(AF_INET, address.c_str(), ignored.data()) == 1
                              : address.find_first_not_of(kNames) == std::string::npos;
  if (known) return success();
  return Error{
      ErrorKind::bad_input,
      fmt::format("'{}' is no address to listen on; 127.0.0.1 is this machine's own, 0.0.0.0 all of its "
                  "networks'",
                  address)};
}

std::string changed_keys(const Config& before, const Config& after) {
  Config old = before, now = after;
  const std::vector<Setting> olds = config_settings(old), news = config_settings(now);
  std::string keys;
  for (std::size_t i = 0; i < olds.size(); ++i) {
    if (setting_value(olds[i]) == setting_value(news[i])) continue;
    if (!keys.empty()) keys += ", ";
    if (!olds[i].table.empty()) keys.append(olds[i].table).append(".");
    keys += olds[i].key;
  }
  return keys;
}

std::string describe_config(const Config& config) {
  Config copy = config;
  return describe_settings(config_settings(copy));
}

}  // namespace pliant

#include "drivers/recording/camera_file.hpp"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "drivers/common/nearest_word.hpp"
#include "drivers/common/printable.hpp"
#include "drivers/common/toml_text.hpp"
#include "drivers/recording/text_file.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

/// One key: where its value goes and what it may be.
struct Key {
  std::string_view name;
  double* value;
  double low, high;
};

class Reader {
 public:
  explicit Reader(std::string_view name) : name_(name) {}

  /// Takes every key of `table`; tables among them must be named in `tables`.
  Outcome take(const toml::table& table, std::span<const Key> keys, std::string_view allowed_table) const {
    for (const auto& [key, node] : table) {
      const Key* known = nullptr;
      for (const Key& k : keys)
        if (k.name == key.str()) known = &k;
      if (known == nullptr && key.str() == allowed_table && !allowed_table.empty()) {
        if (!node.is_table()) return at(key.source(), fmt::format("'{}' must be a table", key.str()));
        continue;
      }
      if (known == nullptr) return unknown(key, keys, allowed_table);
      const auto value = node.value<double>();
      if (!value || !node.is_number())
        return at(node.source(), fmt::format("'{}' must be a number", known->name));
      if (!(*value >= known->low && *value <= known->high))
        return at(node.source(),
                  fmt::format("'{}' is {}; must be {} to {}", known->name, *value, known->low, known->high));
      *known->value = *value;
    }
    return success();
  }

  [[nodiscard]] Error at(const toml::source_region& where, std::string_view what) const {
    return {ErrorKind::bad_input,
            fmt::format("{}:{}:{}: {}", name_, where.begin.line, where.begin.column, what)};
  }
  [[nodiscard]] Error of_file(std::string_view what) const {
    return {ErrorKind::bad_input, fmt::format("{}: {}", name_, what)};
  }

 private:
  [[nodiscard]] Error unknown(const toml::key& key, std::span<const Key> keys,
                              std::string_view allowed_table) const {
    std::vector<std::string_view> names;
    for (const Key& k : keys) names.push_back(k.name);
    if (!allowed_table.empty()) names.push_back(allowed_table);
    return at(key.source(), fmt::format("unknown key '{}'; nearest known key is '{}'", printable(key.str()),
                                        nearest_word(key.str(), names)));
  }

  std::string name_;
};

}  // namespace

Result<CameraFile> parse_camera(std::string_view text, std::string_view name) {
  const Reader reader(name);
  const Result<toml::table> parsed = parse_toml(text, name);
  if (!parsed) return parsed.error();

  CameraFile camera;
  Intrinsics& c = camera.intrinsics;
  SensorDescription& s = camera.sensor;
  const double missing = std::nan("");
  double width = missing, height = missing;
  c.fx = c.fy = c.cx = c.cy = c.depth_scale = missing;
  const std::array<Key, 7> camera_keys{{{"width", &width, 32, 1920},
                                        {"height", &height, 24, 1200},
                                        {"fx", &c.fx, 10, 10000},
                                        {"fy", &c.fy, 10, 10000},
                                        {"cx", &c.cx, -4000, 8000},
                                        {"cy", &c.cy, -4000, 8000},
                                        {"depth_scale", &c.depth_scale, 10, 1000000}}};
  const auto of_sensor = [](std::string_view key, double& value, const SensorDescription::Range& range) {
    return Key{key, &value, range.low, range.high};
  };
  const std::array<Key, 4> sensor_keys = {
      of_sensor("noise_floor", s.noise_floor, SensorDescription::kNoiseFloor),
      of_sensor("noise_growth", s.noise_growth, SensorDescription::kNoiseGrowth),
      of_sensor("near_limit", s.near_limit, SensorDescription::kNearLimit),
      of_sensor("far_limit", s.far_limit, SensorDescription::kFarLimit)};
  const toml::table& root = *parsed;
  if (Outcome taken = reader.take(root, camera_keys, "sensor"); !taken) return taken.error();
  if (const toml::table* sensor = root["sensor"].as_table())
    if (Outcome taken = reader.take(*sensor, sensor_keys, ""); !taken) return taken.error();
  for (const Key& key : camera_keys)
    if (std::isnan(*key.value)) return reader.of_file(fmt::format("'{}' is missing", key.name));
  if (width != std::floor(width) || height != std::floor(height))
    return reader.of_file("width and height must be whole numbers");
  if (const char* fault = sensor_fault(s)) return reader.of_file(fmt::format("sensor: {}", fault));
  c.width = static_cast<int>(width);
  c.height = static_cast<int>(height);
  if (const char* fault = intrinsics_fault(c)) return reader.of_file(fault);
  return camera;
}

Result<CameraFile> read_camera(const std::filesystem::path& file) {
  const Result<std::string> text = read_text_file(file, kMaxBytes);
  if (!text) return text.error();
  return parse_camera(*text, file.string());
}

std::string camera_text(const CameraFile& camera) {
  const Intrinsics& c = camera.intrinsics;
  const SensorDescription& s = camera.sensor;
  return fmt::format(
      "width = {}\nheight = {}\nfx = {}\nfy = {}\ncx = {}\ncy = {}\ndepth_scale = {}\n\n"
      "[sensor]\nnoise_floor = {}\nnoise_growth = {}\nnear_limit = {}\nfar_limit = {}\n",
      c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.depth_scale, s.noise_floor, s.noise_growth, s.near_limit,
      s.far_limit);
}

}  // namespace pliant

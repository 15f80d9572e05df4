#include "firmware-app/config/sensor_file.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "core/limits.hpp"
#include "drivers/recording/text_file.hpp"
#include "firmware-app/config/settings_table.hpp"

namespace pliant {

namespace {

/// Every key of a sensor description.
std::vector<Setting> sensor_settings(SensorFile& s) {
  const auto of_noise = [](const char* key, double& value, const SensorDescription::Range& range,
                           const char* unit, const char* what) {
    return Setting{"noise", key, &value, range.low, range.high, unit, what};
  };
  return {
      {"", "name", &s.name, 0, 200, "", "the sensor's name"},
      {"mode", "width", &s.mode.width, limits::kMinFrameWidth, limits::kMaxFrameWidth, "pixels",
       "of a frame"},
      {"mode", "height", &s.mode.height, limits::kMinFrameHeight, limits::kMaxFrameHeight, "pixels",
       "of a frame"},
      {"mode", "rate", &s.mode.rate, 1, 240, "frames per second", "of the stream"},
      {"camera", "fx", &s.camera.fx, 10, 10000, "pixels", "focal length across"},
      {"camera", "fy", &s.camera.fy, 10, 10000, "pixels", "focal length down"},
      {"camera", "cx", &s.camera.cx, -4000, 8000, "pixels", "principal point across"},
      {"camera", "cy", &s.camera.cy, -4000, 8000, "pixels", "principal point down"},
      {"camera", "depth_scale", &s.camera.depth_scale, 10, 1000000, "raw units per metre", "of a reading"},
      of_noise("noise_floor", s.noise.noise_floor, SensorDescription::kNoiseFloor, "m", "deviation at 0.4 m"),
      of_noise("noise_growth", s.noise.noise_growth, SensorDescription::kNoiseGrowth, "1/m",
               "its growth with (depth - 0.4 m)^2"),
      of_noise("near_limit", s.noise.near_limit, SensorDescription::kNearLimit, "m", "nearest reading used"),
      of_noise("far_limit", s.noise.far_limit, SensorDescription::kFarLimit, "m", "farthest reading used"),
  };
}

}  // namespace

bool SensorFile::says_the_same_as(const SensorFile& other) const {
  const auto values = [](const SensorDescription& d) {
    return std::array{d.noise_floor, d.noise_growth, d.near_limit, d.far_limit};
  };
  return asks_the_same_as(other) && values(noise) == values(other.noise);
}

Outcome parse_sensor(std::string_view text, std::string_view name, SensorFile& sensor) {
  SensorFile candidate = sensor;
  const std::vector<Setting> settings = sensor_settings(candidate);
  if (Outcome parsed = parse_settings(text, name, settings); !parsed) return parsed;
  if (const char* fault = sensor_fault(candidate.noise); fault != nullptr)
    return Error{ErrorKind::bad_input, fmt::format("{}: noise: {}", name, fault)};
  if (const char* fault = intrinsics_fault(candidate.intrinsics()); fault != nullptr)
    return Error{ErrorKind::bad_input, fmt::format("{}: camera: {}", name, fault)};
  sensor = candidate;
  return success();
}

Result<SensorFile> read_sensor(const std::string& path) {
  const Result<std::string> text = read_text_file(path, kMaxSettingsText);
  if (!text) return Error{ErrorKind::bad_input, "cannot read the sensor description " + text.error().message};
  SensorFile sensor;
  if (Outcome parsed = parse_sensor(*text, path, sensor); !parsed) return parsed.error();
  return sensor;
}

}  // namespace pliant

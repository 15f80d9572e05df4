// Description of a sensor model: its mode, nominal camera and noise. config/sensors/ holds ready ones.
#pragma once

#include <string>
#include <string_view>

#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "drivers/common/result.hpp"

namespace pliant {

struct SensorFile {
  std::string name;
  struct Mode {
    int width = 640, height = 480;  ///< pixels
    double rate = 30;               ///< frames per second
    [[nodiscard]] bool operator==(const Mode&) const = default;
  } mode;
  struct Camera {
    double fx = 570.3, fy = 570.3, cx = 319.5, cy = 239.5;  ///< pixels
    double depth_scale = 1000;                              ///< raw units per metre
    [[nodiscard]] bool operator==(const Camera&) const = default;
  } camera;
  SensorDescription noise;

  /// Whether a device that was opened for the one serves the other, too: only the noise may differ.
  [[nodiscard]] bool asks_the_same_as(const SensorFile& other) const {
    return mode == other.mode && camera == other.camera;
  }
  /// Whatever its name.
  [[nodiscard]] bool says_the_same_as(const SensorFile& other) const;
  [[nodiscard]] Intrinsics intrinsics() const {
    return {mode.width, mode.height, camera.fx, camera.fy, camera.cx, camera.cy, camera.depth_scale};
  }
};

/// Reads TOML text; see config/sensors/structure_sensor.toml.
[[nodiscard]] Outcome parse_sensor(std::string_view text, std::string_view name, SensorFile& sensor);
[[nodiscard]] Result<SensorFile> read_sensor(const std::string& path);

}  // namespace pliant

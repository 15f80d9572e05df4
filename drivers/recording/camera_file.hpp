// camera.toml: the camera of a recording.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "drivers/common/result.hpp"

namespace pliant {

/// What camera.toml says: `width height fx fy cx cy` in pixels, `depth_scale` in raw units per metre, all
/// required; optionally a table `[sensor]` with the members of SensorDescription.
struct CameraFile {
  Intrinsics intrinsics;
  SensorDescription sensor;
};

/// Parses the text of a camera.toml; `name` stands in the errors. ErrorKind::bad_input with line and column:
/// not TOML, a key that is unknown (with the nearest known one) or missing, a value of the wrong type or out
/// of range.
[[nodiscard]] Result<CameraFile> parse_camera(std::string_view text, std::string_view name);
/// Reads and parses the file.
[[nodiscard]] Result<CameraFile> read_camera(const std::filesystem::path& file);
/// The text that parse_camera() reads back to the same values.
[[nodiscard]] std::string camera_text(const CameraFile& camera);

}  // namespace pliant

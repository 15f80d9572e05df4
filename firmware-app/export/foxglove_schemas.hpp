// What the messages of an exported log look like, as JSON Schema.
#pragma once

#include <string>
#include <string_view>

namespace pliant {

/// The schema of "foxglove.FrameTransform", "foxglove.PointCloud", "foxglove.RawImage" or
/// "foxglove.CameraCalibration", as Foxglove defines them, or of "pliant.Frame" or "pliant.Status".
[[nodiscard]] std::string message_schema(std::string_view name);

}  // namespace pliant

// Opening devices, and recordings that a library plays.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "drivers/common/result.hpp"
#include "drivers/depth_source/depth_source.hpp"
#include "firmware-app/config/sensor_file.hpp"

namespace pliant {

struct SourceOptions {
  std::optional<SensorFile> sensor;  ///< mode, camera and noise of a device; noise of other sources
  bool keeps_frames = false;         ///< instead of acting on them: of a device, late ones are welcome
  double patience = 60;              ///< seconds that a device may be gone before it is lost for good
};

inline constexpr const char* kLiveSources =
    "openni2:[URI], oni:FILE.oni, lcmlog:FILE, v4l2:/dev/videoN|usb-BUS[?format=Z16]";

/// "openni2:", "openni2:URI", "oni:FILE", "lcmlog:FILE" or "v4l2:PLACE". Null for any other scheme.
[[nodiscard]] Result<std::unique_ptr<DepthSource>> open_live_input(const std::string& uri,
                                                                   const SourceOptions& options);

}  // namespace pliant

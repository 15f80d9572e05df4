// The depth pictures in an LCM log as a source.
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/depth_source/depth_source.hpp"

namespace pliant {

/// Replays the first channel of the log whose messages are depth_t, each picture with its own stamp. A
/// picture with parts missing is a bad frame. ErrorKind::bad_input where the file is no log or holds no
/// depth.
[[nodiscard]] Result<std::unique_ptr<DepthSource>> open_depth_log(const std::filesystem::path& file,
                                                                  const SensorDescription& sensor = {});

}  // namespace pliant

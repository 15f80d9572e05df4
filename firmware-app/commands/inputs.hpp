// Opening what the user names: sources and models.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/model_view.hpp"
#include "drivers/common/result.hpp"
#include "drivers/depth_source/depth_source.hpp"
#include "drivers/model_files/model_file.hpp"
#include "firmware-app/config/sensor_file.hpp"

namespace pliant {

inline constexpr const char* kSourceHelp =
    "Where frames come from: recording:DIR, or simulated:cushion|figure|box, with "
    "?seed=1&noise=structure&frames=300 behind it if wanted";
inline constexpr std::string_view kSourceExample = "simulated:cushion";

}  // namespace pliant

// Opening what the user names: sources and models.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "drivers/common/result.hpp"
#include "drivers/depth_source/depth_source.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/model_file.hpp"
#include "drivers/simulated/simulated.hpp"
#include "firmware-app/commands/live_inputs.hpp"

namespace pliant {

inline constexpr const char* kSourceHelp =
    "Where frames come from: recording:DIR, a device (openni2:[URI], v4l2:/dev/videoN), oni:FILE.oni, "
    "lcmlog:FILE, or "
    "simulated:cushion|figure|box, with ?seed=1&noise=structure&frames=300 behind it if wanted";
inline constexpr std::string_view kSourceExample = "simulated:cushion";

struct OpenSource {
  std::unique_ptr<DepthSource> source;
  const SimulatedSource* simulated = nullptr;  ///< the same, where it is a simulated one: knows the truth
};

/// "recording:DIR", "simulated:..." or a live input. ErrorKind::bad_input names what is wrong and what there
/// is.
[[nodiscard]] Result<OpenSource> open_source(const std::string& uri, const SourceOptions& options = {});

/// What a source's readings are worth: as the sensor's description says where one is given, else as the
/// source does.
[[nodiscard]] SensorDescription sensor_of(const DepthSource& source, const SourceOptions& options);

/// A simulated source needs no model file.
[[nodiscard]] bool brings_own_model(std::string_view source_uri);

/// The model file `path`, or, where that is empty, the model that the source brings.
[[nodiscard]] Result<ModelFile> load_model(const std::string& path, const std::string& source_uri);

/// The geometry that `input` names: a file, or the object of "simulated:...".
[[nodiscard]] Result<Geometry> load_geometry(const std::string& input);

}  // namespace pliant

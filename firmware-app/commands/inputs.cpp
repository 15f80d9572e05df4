#include "firmware-app/commands/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "drivers/recording/recording.hpp"

namespace pliant {

namespace {

constexpr std::string_view kRecording = "recording:";
constexpr std::string_view kSimulated = "simulated:";
constexpr std::string_view kKnown = "simulated:cushion|figure|box[?seed=1&noise=structure&frames=300]";

/// Whether `uri` begins with a scheme: letters and digits before a colon.
bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon > 0 &&
         std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
}

}  // namespace

Result<OpenSource> open_source(const std::string& uri, const SourceOptions& options) {
  OpenSource open;
  if (uri.starts_with(kRecording)) {
    Result<std::unique_ptr<DepthSource>> source = open_recording(uri.substr(kRecording.size()));
    if (!source) return source.error();
    open.source = std::move(*source);
    return open;
  }
  if (uri.starts_with(kSimulated)) {
    Result<std::unique_ptr<SimulatedSource>> source = open_simulated(uri);
    if (!source) return source.error();
    open.simulated = source->get();
    open.source = std::move(*source);
    return open;
  }
  Result<std::unique_ptr<DepthSource>> live = open_live_input(uri, options);
  if (!live) return live.error();
  if (*live != nullptr) {
    open.source = std::move(*live);
    return open;
  }
  std::error_code ignored;
  if (!has_scheme(uri) && std::filesystem::is_directory(uri, ignored))
    return Error{ErrorKind::bad_input, fmt::format("source '{0}' has no scheme; write recording:{0}", uri)};
  if (!has_scheme(uri) && std::filesystem::is_regular_file(uri, ignored))
    return Error{
        ErrorKind::bad_input,
        fmt::format("source '{}' is a file without a scheme; write oni:FILE.oni or lcmlog:FILE of what a "
                    "sensor saw; of a mesh or cloud, 'pliant model build' makes a model",
                    uri)};
  return Error{ErrorKind::bad_input, fmt::format("unknown source '{}'; there are recording:DIR, {} and {}",
                                                 uri, kLiveSources, kKnown)};
}

SensorDescription sensor_of(const DepthSource& source, const SourceOptions& options) {
  return options.sensor ? options.sensor->noise : source.sensor();
}

bool brings_own_model(std::string_view source_uri) {
  return source_uri.starts_with(kSimulated);
}

Result<ModelFile> load_model(const std::string& path, const std::string& source_uri) {
  if (!path.empty()) return ModelFile::open(path);
  const Result<Geometry> geometry = load_geometry(source_uri);
  if (!geometry) return geometry.error();
  Result<BuiltModel> built = build_model(*geometry, {});
  if (!built) return built.error();
  return ModelFile::from_image(std::move(built->image), source_uri);
}

Result<Geometry> load_geometry(const std::string& input) {
  if (!input.starts_with(kSimulated)) return read_geometry(input);
  const Result<std::unique_ptr<SimulatedSource>> source = open_simulated(input);
  if (!source) return source.error();
  return (*source)->mesh();
}

}  // namespace pliant

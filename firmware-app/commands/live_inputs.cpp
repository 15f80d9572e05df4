#include "firmware-app/commands/live_inputs.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "drivers/openni2/openni2.hpp"
#include "firmware-app/pipeline/live_source.hpp"

namespace pliant {

namespace {

using Opened = Result<std::unique_ptr<DepthSource>>;

constexpr std::string_view kOpenNi2 = "openni2:";
constexpr std::string_view kOni = "oni:";

SourceWish wish_of(const SourceOptions& options) {
  SourceWish wish;
  if (options.sensor) {
    wish.camera = options.sensor->intrinsics();
    wish.sensor = options.sensor->noise;
    wish.rate = options.sensor->mode.rate;
  }
  return wish;
}

Opened start(LiveSettings settings, const SourceOptions& options) {
  settings.patience = options.patience;
  Result<std::unique_ptr<LiveSource>> live = LiveSource::open(std::move(settings));
  if (!live) return live.error();
  return std::unique_ptr<DepthSource>(std::move(*live));
}

Opened open_openni2_device(std::string uri, const SourceOptions& options) {
  LiveSettings settings;
  settings.arrivals = std::make_shared<ArrivalSignal>();
  Result<std::shared_ptr<OpenNi2Library>> library = OpenNi2Library::start(settings.arrivals);
  if (!library) return library.error();
  settings.open = [library = std::move(*library), uri = std::move(uri), wish = wish_of(options)] {
    return open_openni2(library, uri, wish);
  };
  return start(std::move(settings), options);
}

Opened open_oni_file(const std::string& file, const SourceOptions& options) {
  if (file.empty()) return Error{ErrorKind::bad_input, "oni: names no file; write oni:FILE.oni"};
  Result<std::shared_ptr<OpenNi2Library>> library = OpenNi2Library::start();
  if (!library) return library.error();
  SourceWish wish = wish_of(options);
  return open_oni(std::move(*library), file, wish);
}

}  // namespace

Opened open_live_input(const std::string& uri, const SourceOptions& options) {
  if (uri.starts_with(kOpenNi2)) return open_openni2_device(uri.substr(kOpenNi2.size()), options);
  if (uri.starts_with(kOni)) return open_oni_file(uri.substr(kOni.size()), options);
  return std::unique_ptr<DepthSource>();
}

}  // namespace pliant

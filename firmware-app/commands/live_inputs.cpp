#include "firmware-app/commands/live_inputs.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "drivers/lcm/depth_log.hpp"
#include "drivers/openni2/openni2.hpp"
#include "drivers/usb/usb_bus.hpp"
#include "drivers/usb/usb_place.hpp"
#include "drivers/v4l2/v4l2.hpp"
#include "firmware-app/pipeline/live_source.hpp"

namespace pliant {

namespace {

using Opened = Result<std::unique_ptr<DepthSource>>;

constexpr std::string_view kOpenNi2 = "openni2:";
constexpr std::string_view kOni = "oni:";
constexpr std::string_view kV4l2 = "v4l2:";
constexpr std::string_view kLcmLog = "lcmlog:";

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
  settings.late_is_welcome = options.keeps_frames;
  Result<std::unique_ptr<LiveSource>> live = LiveSource::open(std::move(settings));
  if (!live) return live.error();
  return std::unique_ptr<DepthSource>(std::move(*live));
}

/// Word of what is plugged in, and the last resort for a device that is there and gives nothing. Both are a
/// help only: where USB cannot be watched the state machine polls.
void attend_usb(LiveSettings& settings) {
  if (settings.arrivals == nullptr) settings.arrivals = std::make_shared<ArrivalSignal>();
  Result<std::shared_ptr<UsbBus>> bus = UsbBus::open();
  if (!bus) return;
  static_cast<void>((*bus)->watch(settings.arrivals));
  settings.reset = [bus = std::move(*bus)](const std::string& place) {
    const Result<std::vector<UsbDevice>> devices = bus->devices();
    if (!devices) return;
    // Another program's camera is left alone: only what is certainly ours.
    if (const UsbDevice* device = find_idle_at_place(*devices, place)) static_cast<void>(bus->reset(*device));
  };
}

Opened open_openni2_device(std::string uri, const SourceOptions& options) {
  LiveSettings settings;
  settings.arrivals = std::make_shared<ArrivalSignal>();
  Result<std::shared_ptr<OpenNi2Library>> library = OpenNi2Library::start(settings.arrivals);
  if (!library) return library.error();
  attend_usb(settings);
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

Opened open_lcm_log(const std::string& file, const SourceOptions& options) {
  if (file.empty()) return Error{ErrorKind::bad_input, "lcmlog: names no file; write lcmlog:FILE"};
  return open_depth_log(file, wish_of(options).sensor);
}

Opened open_v4l2_device(std::string_view text, const SourceOptions& options) {
  const Result<V4l2Address> address = parse_v4l2_address(text);
  if (!address) return address.error();
  LiveSettings settings;
  attend_usb(settings);
  settings.open = [address = *address, wish = wish_of(options)] { return open_v4l2(address, wish); };
  return start(std::move(settings), options);
}

}  // namespace

Opened open_live_input(const std::string& uri, const SourceOptions& options) {
  if (uri.starts_with(kOpenNi2)) return open_openni2_device(uri.substr(kOpenNi2.size()), options);
  if (uri.starts_with(kOni)) return open_oni_file(uri.substr(kOni.size()), options);
  if (uri.starts_with(kV4l2)) return open_v4l2_device(std::string_view(uri).substr(kV4l2.size()), options);
  if (uri.starts_with(kLcmLog)) return open_lcm_log(uri.substr(kLcmLog.size()), options);
  return std::unique_ptr<DepthSource>();
}

}  // namespace pliant

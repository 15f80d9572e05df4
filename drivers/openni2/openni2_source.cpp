// A live device.
#include <fmt/format.h>

#include <utility>

#include "drivers/common/clock.hpp"
#include "drivers/depth_source/device_clock.hpp"
#include "drivers/openni2/openni2.hpp"
#include "drivers/openni2/openni2_stream.hpp"

namespace pliant {

namespace {

class OpenNi2Source final : public DepthSource {
 public:
  OpenNi2Source(std::shared_ptr<OpenNi2Library> library, const SensorDescription& sensor)
      : library_(std::move(library)), sensor_(sensor), stream_(library_) {}

  [[nodiscard]] Outcome open(const std::string& uri, const SourceWish& wish) {
    place_ = uri;
    gone_ = library_->watch(uri);
    if (Outcome done = stream_.open(uri); !done) return done;
    if (Outcome done = stream_.set_up(wish); !done) return done;
    return stream_.start();
  }
  [[nodiscard]] const Intrinsics& intrinsics() const override { return stream_.camera(); }
  [[nodiscard]] const SensorDescription& sensor() const override { return sensor_; }
  [[nodiscard]] bool live() const override { return true; }
  [[nodiscard]] double rate() const override { return stream_.rate(); }
  [[nodiscard]] std::string place() const override { return place_; }
  void close() override {
    stream_.close();
    closed_ = true;
  }

  void next(int timeout_ms, SourceItem& item) override {
    item.frame = {};
    item.fault.clear();
    item.event = SourceEvent::end;
    if (closed_) return;
    if (gone_->load()) {
      item.event = SourceEvent::lost;
      item.fault = "openni2: the device was unplugged or failed";
      return;
    }
    std::int64_t step = 0;
    switch (stream_.read(timeout_ms, item.frame, item.fault)) {
      case OpenNi2Stream::Got::frame: {
        item.event = SourceEvent::frame;
        // What the library had no room for leaves a gap in its count; a step beyond a minute is no gap.
        step = index_ < 0 ? 1 : item.frame.number - index_;
        if (step < 1 || step > kLongestGap) step = 1;
        index_ = item.frame.number;
        // The device's clock runs evenly, as our monotonic one does; the wall clock may be set at any time.
        const std::int64_t arrival = clock_us(CLOCK_MONOTONIC);
        const std::int64_t captured = clock_.to_ours(item.frame.utime, arrival);
        item.frame.utime = captured + clock_us(CLOCK_REALTIME) - arrival;
        break;
      }
      case OpenNi2Stream::Got::unfit:
        item.event = SourceEvent::bad_frame;
        index_ = -1;
        step = 1;
        break;
      case OpenNi2Stream::Got::timeout:
        item.event = SourceEvent::timeout;
        break;
      case OpenNi2Stream::Got::failed:
        item.event = SourceEvent::lost;
        break;
    }
    number_ += step;
    item.frame.number = number_;
  }

 private:
  std::shared_ptr<OpenNi2Library> library_;
  SensorDescription sensor_;
  std::string place_;
  std::shared_ptr<std::atomic<bool>> gone_;
  OpenNi2Stream stream_;
  DeviceClock clock_;
  static constexpr std::int64_t kLongestGap = 1800;
  std::int64_t number_ = -1;  // of the latest frame
  std::int64_t index_ = -1;   // the library's own of the latest, where it is known
  bool closed_ = false;
};

/// The device meant by `uri`, empty where there is none.
std::string find(const std::vector<OpenNi2Device>& devices, std::string_view uri) {
  if (uri.empty()) return devices.empty() ? std::string() : devices.front().uri;
  for (const OpenNi2Device& device : devices)
    if (device.uri == uri) return device.uri;
  const std::string_view place = uri.substr(0, uri.rfind('/') + 1);
  for (const OpenNi2Device& device : devices)
    if (!place.empty() && device.uri.starts_with(place)) return device.uri;
  return {};
}

}  // namespace

Result<std::unique_ptr<DepthSource>> open_openni2(std::shared_ptr<OpenNi2Library> library,
                                                  std::string_view uri, const SourceWish& wish) {
  const Result<std::vector<OpenNi2Device>> devices = library->devices();
  if (!devices) return devices.error();
  const std::string found = find(*devices, uri);
  if (found.empty())
    return Error{ErrorKind::absent,
                 uri.empty() ? std::string("openni2: no device is plugged in; 'pliant devices' "
                                           "tells what is seen and what to check")
                             : fmt::format("openni2: no device '{}'; 'pliant devices' lists them", uri)};
  auto source = std::make_unique<OpenNi2Source>(std::move(library), wish.sensor);
  if (const Outcome opened = source->open(found, wish); !opened) return opened.error();
  return std::unique_ptr<DepthSource>(std::move(source));
}

}  // namespace pliant

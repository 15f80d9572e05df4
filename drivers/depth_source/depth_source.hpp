// The one interface of everything that delivers depth frames.
#pragma once

#include <cstdint>
#include <string>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "drivers/common/result.hpp"
#include "drivers/depth_source/device_monitor.hpp"

namespace pliant {

/// What a call of DepthSource::next() brought.
enum class SourceEvent {
  frame,      ///< `frame` is set
  bad_frame,  ///< a frame came that cannot be used; `fault` says why. Its number is spent.
  timeout,    ///< none within the time given
  end,        ///< the source is at its end
  lost        ///< the device is gone for good; `fault` says why
};

struct SourceItem {
  SourceEvent event = SourceEvent::timeout;
  DepthFrame frame;   ///< borrowed until the next call of next() or close()
  std::string fault;  ///< one line; empty for frame and end, for timeout where nothing new is to be said
};

/// Opened by its maker; closed by close() or the destructor. One thread uses it.
class DepthSource {
 public:
  DepthSource() = default;
  DepthSource(const DepthSource&) = delete;
  DepthSource& operator=(const DepthSource&) = delete;
  virtual ~DepthSource() = default;

  [[nodiscard]] virtual const Intrinsics& intrinsics() const = 0;
  [[nodiscard]] virtual const SensorDescription& sensor() const = 0;
  /// A live source runs at its own pace and drops what is not fetched in time.
  [[nodiscard]] virtual bool live() const = 0;
  /// Frames in all, -1 where unknown.
  [[nodiscard]] virtual std::int64_t frame_count() const { return -1; }
  /// Frames a second that the mode promises.
  [[nodiscard]] virtual double rate() const { return 30; }
  /// Where the device is plugged in, as its driver names it: OpenNI2's URI ("1d27/0600@1/5"), V4L2's bus id
  /// ("usb-0000:00:14.0-2"); empty for what is no device.
  [[nodiscard]] virtual std::string place() const { return {}; }
  /// How the device fares, where the source watches it; else null.
  [[nodiscard]] virtual const DeviceMonitor* monitor() const { return nullptr; }
  /// The next frame, waiting at most `timeout_ms`. Reuses `item`'s storage; no heap call for a frame that is
  /// well.
  virtual void next(int timeout_ms, SourceItem& item) = 0;
  virtual void close() = 0;
};

}  // namespace pliant

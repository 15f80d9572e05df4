// What is plugged in, and word of what comes and goes, through libusb.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "drivers/common/result.hpp"
#include "drivers/depth_source/arrival_signal.hpp"

struct libusb_context;

namespace pliant {

/// A device on the bus.
struct UsbDevice {
  std::uint16_t vendor = 0, product = 0;
  int bus = 0, address = 0;
  std::string port;                        ///< "1-2.4": bus and the ports on the way to it
  int megabits = 0;                        ///< of its connection, 0 where unknown
  std::vector<int> classes;                ///< of its interfaces
  bool accessible = false;                 ///< this user may open its node
  bool in_use = false;                     ///< a program has one of its interfaces
  [[nodiscard]] std::string node() const;  ///< "/dev/bus/usb/001/005"
};

class UsbBus {
 public:
  /// ErrorKind::device where libusb cannot start.
  [[nodiscard]] static Result<std::shared_ptr<UsbBus>> open();
  ~UsbBus();
  UsbBus(const UsbBus&) = delete;
  UsbBus& operator=(const UsbBus&) = delete;

  [[nodiscard]] Result<std::vector<UsbDevice>> devices() const;
  /// From now on `arrivals` is told whenever a device comes or goes, by a thread of its own. An error where
  /// the system gives no such word (then polling has to do).
  [[nodiscard]] Outcome watch(std::shared_ptr<ArrivalSignal> arrivals);
  /// Resets the device's port, as if it were plugged out and in. ErrorKind::absent where it is not there.
  [[nodiscard]] Outcome reset(const UsbDevice& device) const;
  [[nodiscard]] std::uint64_t arrived() const noexcept { return arrived_.load(); }
  [[nodiscard]] std::uint64_t left() const noexcept { return left_.load(); }

 private:
  explicit UsbBus(libusb_context* context) : context_(context) {}
  void stop_watching();

  libusb_context* context_;
  std::shared_ptr<ArrivalSignal> arrivals_;
  int callback_ = -1;
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> arrived_{0}, left_{0};
  std::thread thread_;
};

}  // namespace pliant

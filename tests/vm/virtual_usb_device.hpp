// A USB device made of software, plugged into this machine's own kernel.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace pliant::test {

using Bytes = std::vector<std::uint8_t>;

/// A control request's eight bytes (USB 2.0, 9.3).
struct UsbRequest {
  std::uint8_t type = 0, request = 0;
  std::uint16_t value = 0, index = 0, length = 0;
};

/// Numbers as USB descriptors hold them, low byte first.
void put8(Bytes& bytes, unsigned value);
void put16(Bytes& bytes, unsigned value);
void put32(Bytes& bytes, std::uint32_t value);

/// Speaks the kernel's USB/IP protocol (Documentation/usb/usbip_protocol.rst) with the module vhci-hcd over a
/// pair of sockets; a thread of its own answers. To the rest of the kernel and to libusb it is a device at a
/// high-speed port. Needs root and vhci-hcd.
class VirtualUsbDevice {
 public:
  VirtualUsbDevice() = default;
  VirtualUsbDevice(const VirtualUsbDevice&) = delete;
  VirtualUsbDevice& operator=(const VirtualUsbDevice&) = delete;
  /// Unplugged by whoever derives from it, before its own members go.
  virtual ~VirtualUsbDevice() = default;

  /// Plugs it into this port of vhci-hcd's first hub, 0 to 7. What failed; empty when it is plugged in.
  [[nodiscard]] std::string plug(int port);
  void unplug();
  /// Times that the host set the configuration: once after plugging in, and once after each port reset.
  [[nodiscard]] int configurations() const noexcept { return configurations_; }

 protected:
  // All of them are called by the device's thread.
  [[nodiscard]] virtual Bytes device_descriptor() const = 0;
  [[nodiscard]] virtual Bytes configuration_descriptor() const = 0;
  [[nodiscard]] virtual std::string text(int index) const = 0;  ///< string descriptor
  virtual void configured() {}                                  ///< begins anew
  virtual void halt_cleared() {}
  /// A class or vendor request: the answer, or nothing to refuse it. `data` is what the host sent.
  [[nodiscard]] virtual std::optional<Bytes> request(const UsbRequest& what,
                                                     std::span<const std::uint8_t> data) = 0;
  /// Data of a bulk endpoint, `most` bytes at most; nothing where none is due before `due_ns` (monotonic).
  [[nodiscard]] virtual std::optional<Bytes> bulk(int endpoint, std::size_t most, std::int64_t now_ns,
                                                  std::int64_t& due_ns) = 0;

 private:
  struct Pending {
    std::uint32_t sequence = 0;
    int endpoint = 0;
    std::size_t bytes = 0;
  };
  struct Gone {};  // thrown inside the thread when the host has closed the connection

  void serve();
  std::int64_t answer_bulk();  // when the next is due
  void take_command();
  void control(std::uint32_t sequence, bool in, const UsbRequest& what, std::span<const std::uint8_t> data);
  [[nodiscard]] std::optional<Bytes> standard(const UsbRequest& what);
  [[nodiscard]] std::optional<Bytes> descriptor(const UsbRequest& what) const;
  void unlink(std::uint32_t sequence, std::uint32_t meant);
  void answer(std::uint32_t sequence, int status, std::span<const std::uint8_t> data, std::size_t taken);
  void write_header(std::uint32_t kind, std::uint32_t sequence, int status, std::size_t taken);
  void read_all(std::span<std::uint8_t> bytes) const;
  void write_all(std::span<const std::uint8_t> bytes) const;

  int socket_ = -1;
  std::atomic<bool> stop_{false};
  std::atomic<int> configurations_{0};
  std::deque<Pending> pending_;
  std::thread thread_;
};

}  // namespace pliant::test

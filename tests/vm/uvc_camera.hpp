// A depth camera of the USB video class, made of software.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "tests/vm/virtual_usb_device.hpp"

namespace pliant::test {

/// Streams pictures of 16-bit readings as Z16 over a bulk endpoint, forth and back through those it was
/// given.
class UvcCamera final : public VirtualUsbDevice {
 public:
  struct Mode {
    int width = 0, height = 0, rate = 0;  ///< pixels, frames a second
  };
  UvcCamera(std::uint16_t vendor, std::uint16_t product, const Mode& mode,
            std::vector<std::vector<std::uint16_t>> pictures);
  ~UvcCamera() override { unplug(); }

  /// Pictures handed to the host whole.
  [[nodiscard]] int sent() const noexcept { return sent_; }
  /// No more pictures until the host resets the port, as with firmware that hangs.
  void hang() noexcept { hung_ = true; }
  [[nodiscard]] bool hung() const noexcept { return hung_; }

 protected:
  [[nodiscard]] Bytes device_descriptor() const override;
  [[nodiscard]] Bytes configuration_descriptor() const override;
  [[nodiscard]] std::string text(int index) const override;
  void configured() override;
  void halt_cleared() override { offset_ = 0; }
  [[nodiscard]] std::optional<Bytes> request(const UsbRequest& what,
                                             std::span<const std::uint8_t> data) override;
  [[nodiscard]] std::optional<Bytes> bulk(int endpoint, std::size_t most, std::int64_t now_ns,
                                          std::int64_t& due_ns) override;

 private:
  [[nodiscard]] Bytes stream_settings() const;
  [[nodiscard]] std::uint32_t picture_bytes() const;
  [[nodiscard]] std::uint32_t interval() const;  // of 100 ns

  const std::uint16_t vendor_, product_;
  const Mode mode_;
  const std::vector<std::vector<std::uint16_t>> pictures_;
  std::size_t offset_ = 0;  // of the picture under way, bytes
  unsigned count_ = 0;
  std::int64_t next_ns_ = 0;
  std::atomic<int> sent_{0};
  std::atomic<bool> hung_{false};
};

}  // namespace pliant::test

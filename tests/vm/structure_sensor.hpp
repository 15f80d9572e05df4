// A Structure Sensor as far as a bus shows it, made of software.
#pragma once

#include "tests/vm/virtual_usb_device.hpp"

namespace pliant::test {

/// The ids and the interface of a Structure Sensor (1d27:0600): vendor-specific, with bulk endpoints for
/// depth, picture and the rest. It refuses every request of its firmware's protocol.
class StructureSensor final : public VirtualUsbDevice {
 public:
  ~StructureSensor() override { unplug(); }

 protected:
  [[nodiscard]] Bytes device_descriptor() const override;
  [[nodiscard]] Bytes configuration_descriptor() const override;
  [[nodiscard]] std::string text(int index) const override;
  [[nodiscard]] std::optional<Bytes> request(const UsbRequest& /*what*/,
                                             std::span<const std::uint8_t> /*data*/) override {
    return std::nullopt;
  }
  [[nodiscard]] std::optional<Bytes> bulk(int /*endpoint*/, std::size_t /*most*/, std::int64_t /*now_ns*/,
                                          std::int64_t& /*due_ns*/) override {
    return std::nullopt;
  }
};

}  // namespace pliant::test

// The depth cameras that are known by their USB ids.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace pliant {

/// What serves a device.
enum class UsbAccess : std::uint8_t {
  openni2,     ///< libOpenNI2's PS1080 or PSLink driver: openni2:
  v4l2,        ///< the kernel's uvcvideo: v4l2:
  unsupported  ///< no free driver of these kinds
};

/// Stands for all products of a vendor.
inline constexpr std::uint16_t kAnyProduct = 0;

struct UsbDeviceKind {
  std::uint16_t vendor, product;
  std::string_view name;
  UsbAccess access;
  std::string_view sensor;  ///< its description in config/sensors, empty where there is none
  std::string_view remark;  ///< what a user should know, empty where there is nothing
  bool needs_usb3 = false;
};

[[nodiscard]] std::span<const UsbDeviceKind> usb_device_kinds();
/// Null where the ids are not in the table.
[[nodiscard]] const UsbDeviceKind* find_usb_device_kind(std::uint16_t vendor, std::uint16_t product);

}  // namespace pliant

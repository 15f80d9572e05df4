#include "drivers/usb/usb_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace pliant {

namespace {

std::string ids_of(const UsbDevice& device) {
  return fmt::format("{:04x}/{:04x}@", device.vendor, device.product);
}

/// The only one of them for which `holds`; null where none or several do.
template <typename Holds>
const UsbDevice* only(std::span<const UsbDevice> devices, const Holds& holds) {
  const UsbDevice* found = nullptr;
  for (const UsbDevice& device : devices) {
    if (!holds(device)) continue;
    if (found != nullptr) return nullptr;
    found = &device;
  }
  return found;
}

}  // namespace

bool is_at_place(const UsbDevice& device, std::string_view place) {
  if (!place.starts_with("usb-"))
    return place == fmt::format("{}{}/{}", ids_of(device), device.bus, device.address);
  // The kernel's video nodes of USB are served by interfaces of the video class, where these are known.
  constexpr int kVideoClass = 14;
  const std::vector<int>& classes = device.classes;
  const bool video =
      classes.empty() || std::find(classes.begin(), classes.end(), kVideoClass) != classes.end();
  const std::size_t dash = device.port.find('-');  // a root hub has none
  return video && dash != std::string::npos && place.ends_with(std::string_view(device.port).substr(dash));
}

const UsbDevice* find_at_place(std::span<const UsbDevice> devices, std::string_view place) {
  if (const UsbDevice* found = only(devices, [place](const UsbDevice& d) { return is_at_place(d, place); }))
    return found;
  return only(devices, [place](const UsbDevice& device) { return place.starts_with(ids_of(device)); });
}

const UsbDevice* find_idle_at_place(std::span<const UsbDevice> devices, std::string_view place) {
  const UsbDevice* found = find_at_place(devices, place);
  return found == nullptr || found->in_use ? nullptr : found;
}

}  // namespace pliant

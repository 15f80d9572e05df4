// Which device on the bus another driver means.
#pragma once

#include <span>
#include <string_view>

#include "drivers/usb/usb_bus.hpp"

namespace pliant {

/// Whether `place` (DepthSource::place()) is where this device is plugged in: OpenNI2's "1d27/0600@1/5" (ids,
/// bus, address), or V4L2's "usb-0000:00:14.0-2.4" (controller, ports on the way). V4L2 names the controller
/// by its place on the machine's own bus, which is not looked at.
[[nodiscard]] bool is_at_place(const UsbDevice& device, std::string_view place);

/// The one that is at `place`. Where OpenNI2's address is no longer true, because the device has come back
/// with a new one: the one with its ids, if there is only one. Null where it cannot be told.
[[nodiscard]] const UsbDevice* find_at_place(std::span<const UsbDevice> devices, std::string_view place);

/// The same, but null where a program has it. To be asked by who has let go of the device himself: the
/// program is another one then, and the device, maybe, the only other of its kind.
[[nodiscard]] const UsbDevice* find_idle_at_place(std::span<const UsbDevice> devices, std::string_view place);

}  // namespace pliant

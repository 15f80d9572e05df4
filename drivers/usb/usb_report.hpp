// What can be said of depth cameras on the bus: usable, and by what, or why not.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "drivers/usb/usb_bus.hpp"
#include "drivers/usb/usb_devices.hpp"

namespace pliant {

enum class UsbTrouble : std::uint8_t {
  none,
  unsupported,    ///< no free driver
  no_permission,  ///< the user may not open it
  wrong_mode,     ///< on a USB 2 port where it needs USB 3
  no_driver,      ///< nothing on this system serves it
  busy            ///< another program has it
};

struct UsbFinding {
  UsbDevice device;
  const UsbDeviceKind* kind = nullptr;
  UsbTrouble trouble = UsbTrouble::none;
  std::string reason;  ///< why it cannot be used, with the mend; empty where it can
};

/// What the other drivers see, so that a finding can say "no driver" and "busy".
struct UsbServed {
  std::vector<std::pair<std::uint16_t, std::uint16_t>> by_openni2;  ///< vendor and product of what it lists
  std::vector<std::string> video_buses;  ///< bus ids of video nodes: "usb-0000:00:14.0-2"
  std::vector<std::string> busy_buses;   ///< of depth nodes that another program streams from
  std::string hidden_node;               ///< why a video node could not be asked; empty where all could
};

/// What keeps this user from opening a device that OpenNI2 serves, which lists what it cannot open, too.
struct UsbHindrance {
  UsbTrouble trouble = UsbTrouble::none;  ///< none, no_permission or busy
  std::string reason;                     ///< with the mend; empty where there is none
};
[[nodiscard]] UsbHindrance hindrance_of(const UsbDevice& device);

/// The depth cameras among `devices`, each with what is in its way.
[[nodiscard]] std::vector<UsbFinding> judge_usb_devices(std::span<const UsbDevice> devices,
                                                        const UsbServed& served);

/// The udev line that lets whoever sits at the machine, and the group video, use a device.
[[nodiscard]] std::string udev_rule(std::uint16_t vendor, std::uint16_t product);

}  // namespace pliant

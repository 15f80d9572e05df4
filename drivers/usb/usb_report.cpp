#include "drivers/usb/usb_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "drivers/usb/usb_place.hpp"

namespace pliant {

namespace {

constexpr int kUsb3Megabits = 5000;

/// The first thing in a device's way.
void judge(UsbFinding& finding, const UsbServed& served) {
  const UsbDevice& device = finding.device;
  const UsbDeviceKind& kind = *finding.kind;
  const auto set = [&finding](UsbTrouble trouble, std::string reason) {
    finding.trouble = trouble;
    finding.reason = std::move(reason);
  };
  if (kind.access == UsbAccess::unsupported) return set(UsbTrouble::unsupported, std::string(kind.remark));
  if (kind.needs_usb3 && device.megabits != 0 && device.megabits < kUsb3Megabits)
    return set(UsbTrouble::wrong_mode,
               fmt::format("is connected by USB 2 ({} Mbit/s); plug it into a USB 3 port with a USB 3 cable",
                           device.megabits));
  if (kind.access == UsbAccess::openni2) {
    UsbHindrance hindrance = hindrance_of(device);
    if (hindrance.trouble == UsbTrouble::no_permission)
      return set(hindrance.trouble, std::move(hindrance.reason));
    const bool listed = std::find(served.by_openni2.begin(), served.by_openni2.end(),
                                  std::pair(device.vendor, device.product)) != served.by_openni2.end();
    if (!listed)
      return set(UsbTrouble::no_driver,
                 kind.remark.empty()
                     ? std::string("OpenNI2 does not list it; is the package libopenni2-0 whole?")
                     : std::string(kind.remark));
    return set(hindrance.trouble, std::move(hindrance.reason));
  }
  const auto is_here = [&device](const std::string& bus) { return is_at_place(device, bus); };
  if (std::any_of(served.busy_buses.begin(), served.busy_buses.end(), is_here))
    return set(UsbTrouble::busy, "another program uses its depth node");
  if (std::any_of(served.video_buses.begin(), served.video_buses.end(), is_here)) return;
  if (!served.hidden_node.empty())
    return set(UsbTrouble::no_permission,
               "its video node may be one that cannot be asked: " + served.hidden_node);
  set(UsbTrouble::no_driver,
      "no video node serves it; is the module uvcvideo loaded ('modprobe uvcvideo'), and does its kernel "
      "know this model?");
}

}  // namespace

UsbHindrance hindrance_of(const UsbDevice& device) {
  if (!device.accessible)
    return {
        UsbTrouble::no_permission,
        fmt::format("no permission for {}; be in the group video ('sudo adduser $USER video', then log in "
                    "again), add this line to /etc/udev/rules.d/60-pliant.rules and plug it in again: {}",
                    device.node(), udev_rule(device.vendor, device.product))};
  if (device.in_use)
    return {UsbTrouble::busy, fmt::format("another program uses it ('fuser {}' tells which)", device.node())};
  return {};
}

std::vector<UsbFinding> judge_usb_devices(std::span<const UsbDevice> devices, const UsbServed& served) {
  std::vector<UsbFinding> findings;
  for (const UsbDevice& device : devices) {
    const UsbDeviceKind* kind = find_usb_device_kind(device.vendor, device.product);
    if (kind == nullptr) continue;
    findings.push_back({device, kind, UsbTrouble::none, ""});
    judge(findings.back(), served);
  }
  return findings;
}

std::string udev_rule(std::uint16_t vendor, std::uint16_t product) {
  return fmt::format(
      R"(SUBSYSTEM=="usb", ATTR{{idVendor}}=="{:04x}", ATTR{{idProduct}}=="{:04x}", TAG+="uaccess", )"
      R"(GROUP="video", MODE="0660")",
      vendor, product);
}

}  // namespace pliant

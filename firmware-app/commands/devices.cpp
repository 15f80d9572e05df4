// pliant devices: what can be tracked with, and why the rest cannot.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers/openni2/openni2_library.hpp"
#include "drivers/usb/usb_place.hpp"
#include "drivers/usb/usb_report.hpp"
#include "drivers/v4l2/v4l2.hpp"
#include "drivers/v4l2/v4l2_format.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"

namespace pliant {

namespace {

constexpr const char* kWhatToCheck =
    "no depth device is seen. Check that\n"
    "  - it is plugged in and has power (its own supply, or a port that gives enough): 'lsusb' lists it\n"
    "  - the cable carries data; a RealSense needs a USB 3 port and cable\n"
    "  - a video device has its node: 'ls /dev/video*'; else 'modprobe uvcvideo'\n"
    "  - inside a container or virtual machine, USB and /dev/video* are passed through\n";

struct Lines {
  std::string usable, hindered, notes;
};

void list_openni2(Lines& lines, const std::vector<UsbDevice>& on_bus, UsbServed& served) {
  const Result<std::shared_ptr<OpenNi2Library>> library = OpenNi2Library::start();
  if (!library) {
    lines.notes += library.error().message + "\n";
    return;
  }
  const Result<std::vector<OpenNi2Device>> devices = (*library)->devices();
  if (!devices) {
    lines.notes += devices.error().message + "\n";
    return;
  }
  for (const OpenNi2Device& device : *devices) {
    served.by_openni2.emplace_back(device.vendor_id, device.product_id);
    const std::string what = fmt::format("openni2:{}  {} {}", device.uri, device.vendor, device.name);
    const UsbDevice* usb = find_at_place(on_bus, device.uri);
    const UsbHindrance hindrance = usb == nullptr ? UsbHindrance{} : hindrance_of(*usb);
    if (hindrance.trouble == UsbTrouble::none)
      lines.usable += what + "\n";
    else if (find_usb_device_kind(usb->vendor, usb->product) == nullptr)  // list_usb() tells of the others
      lines.hindered += fmt::format("{}: {}\n", what, hindrance.reason);
  }
}

void list_video(Lines& lines, UsbServed& served) {
  const V4l2Listing listing = list_v4l2();
  for (const V4l2Node& node : listing.nodes) {
    served.video_buses.push_back(node.bus);
    if (!node.offers_depth()) continue;
    if (node.busy) served.busy_buses.push_back(node.bus);
    std::string formats;
    for (const std::uint32_t code : node.formats)
      if (find_v4l2_format(code) != nullptr) formats.append(1, ' ').append(fourcc_text(code));
    const std::string what = fmt::format("v4l2:{}  {}, {},{}", node.path, node.card, node.bus, formats);
    if (node.busy)
      lines.hindered +=
          fmt::format("{}: another program uses it ('fuser {}' tells which)\n", what, node.path);
    else
      lines.usable += fmt::format("{}\n", what);
  }
  for (const Error& fault : listing.faults) {
    served.hidden_node = fault.message;
    lines.hindered += fault.message + "\n";
  }
}

std::vector<UsbDevice> devices_on_bus(Lines& lines) {
  const Result<std::shared_ptr<UsbBus>> bus = UsbBus::open();
  const Result<std::vector<UsbDevice>> devices =
      bus ? (*bus)->devices() : Result<std::vector<UsbDevice>>(bus.error());
  if (devices) return *devices;
  lines.notes += devices.error().message + "\n";
  return {};
}

void list_usb(Lines& lines, const std::vector<UsbDevice>& on_bus, const UsbServed& served) {
  for (const UsbFinding& finding : judge_usb_devices(on_bus, served)) {
    const UsbDevice& device = finding.device;
    const std::string what = fmt::format("usb {} {:04x}:{:04x} {}", device.port, device.vendor,
                                         device.product, finding.kind->name);
    if (finding.trouble != UsbTrouble::none)
      lines.hindered += fmt::format("{}: {}\n", what, finding.reason);
    else if (!finding.kind->sensor.empty())
      lines.notes += fmt::format("{}: its description is config/sensors/{}\n", what, finding.kind->sensor);
  }
}

int devices() {
  Lines lines;
  UsbServed served;
  const std::vector<UsbDevice> on_bus = devices_on_bus(lines);
  list_openni2(lines, on_bus, served);
  list_video(lines, served);
  list_usb(lines, on_bus, served);
  std::string text;
  const auto add = [&text](const char* heading, const std::string& under) {
    if (!under.empty()) text.append(heading).append(under);
  };
  add("sources:\n", lines.usable);
  add("cannot be used:\n", lines.hindered);
  if (text.empty()) text = kWhatToCheck;
  add("notes:\n", lines.notes);
  return print(text) ? kExitDone : kExitFailed;
}

}  // namespace

void add_devices(CLI::App& program, Work& work) {
  CLI::App* app =
      program.add_subcommand("devices", "List depth devices, and why one that is there cannot be used");
  app->callback([&work] { work = [] { return devices(); }; });
}

}  // namespace pliant

#include "drivers/usb/usb_bus.hpp"

#include <fmt/format.h>
#include <libusb.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <system_error>

namespace pliant {

namespace {

Error fault(const char* what, int code) {
  return {ErrorKind::device, fmt::format("usb: {}: {}", what, libusb_error_name(code))};
}

int megabits_of(int speed) {
  switch (speed) {
    case LIBUSB_SPEED_LOW:
      return 1;
    case LIBUSB_SPEED_FULL:
      return 12;
    case LIBUSB_SPEED_HIGH:
      return 480;
    case LIBUSB_SPEED_SUPER:
      return 5000;
    case LIBUSB_SPEED_SUPER_PLUS:
      return 10000;
    default:
      return 0;
  }
}

/// The kernel names "usbfs" as the driver of an interface that a program has claimed.
bool claimed_by_program(const std::string& port, int configuration, int interface) {
  const std::string driver =
      fmt::format("/sys/bus/usb/devices/{}:{}.{}/driver", port, configuration, interface);
  std::error_code none;
  return std::filesystem::read_symlink(driver, none).filename() == "usbfs";
}

UsbDevice describe(libusb_device* device, const libusb_device_descriptor& descriptor) {
  UsbDevice d;
  d.vendor = descriptor.idVendor;
  d.product = descriptor.idProduct;
  d.bus = libusb_get_bus_number(device);
  d.address = libusb_get_device_address(device);
  std::array<std::uint8_t, 8> ports{};
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  d.port = fmt::format("{}", d.bus);
  for (int i = 0; i < depth; ++i)
    d.port += fmt::format("{}{}", i == 0 ? '-' : '.', ports[static_cast<std::size_t>(i)]);
  d.megabits = megabits_of(libusb_get_device_speed(device));
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) == 0) {
    for (int i = 0; i < config->bNumInterfaces; ++i) {
      if (config->interface[i].num_altsetting < 1) continue;
      const libusb_interface_descriptor& interface = config->interface[i].altsetting[0];
      d.classes.push_back(interface.bInterfaceClass);
      d.in_use =
          d.in_use || claimed_by_program(d.port, config->bConfigurationValue, interface.bInterfaceNumber);
    }
    libusb_free_config_descriptor(config);
  }
  d.accessible = ::access(d.node().c_str(), R_OK | W_OK) == 0;
  return d;
}

/// The list that libusb hands out.
class DeviceList {
 public:
  explicit DeviceList(libusb_context* context) : count_(libusb_get_device_list(context, &list_)) {}
  ~DeviceList() {
    if (list_ != nullptr) libusb_free_device_list(list_, 1);
  }
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;
  [[nodiscard]] ssize_t count() const { return count_; }
  [[nodiscard]] libusb_device* at(ssize_t i) const { return list_[i]; }

 private:
  libusb_device** list_ = nullptr;
  ssize_t count_;
};

}  // namespace

std::string UsbDevice::node() const {
  return fmt::format("/dev/bus/usb/{:03}/{:03}", bus, address);
}

Result<std::shared_ptr<UsbBus>> UsbBus::open() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != 0) return fault("libusb cannot start", code);
  return std::shared_ptr<UsbBus>(new UsbBus(context));
}

UsbBus::~UsbBus() {
  stop_watching();
  libusb_exit(context_);
}

Result<std::vector<UsbDevice>> UsbBus::devices() const {
  const DeviceList list(context_);
  if (list.count() < 0) return fault("devices cannot be listed", static_cast<int>(list.count()));
  std::vector<UsbDevice> devices;
  for (ssize_t i = 0; i < list.count(); ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list.at(i), &descriptor) == 0)
      devices.push_back(describe(list.at(i), descriptor));
  }
  std::sort(devices.begin(), devices.end(), [](const UsbDevice& a, const UsbDevice& b) {
    return a.bus != b.bus ? a.bus < b.bus : a.address < b.address;
  });
  return devices;
}

Outcome UsbBus::watch(std::shared_ptr<ArrivalSignal> arrivals) {
  stop_watching();
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0)
    return Error{ErrorKind::device, "usb: this system tells nothing of devices that come and go"};
  arrivals_ = std::move(arrivals);
  const auto told = [](libusb_context* /*context*/, libusb_device* /*device*/, libusb_hotplug_event event,
                       void* self) {
    auto& bus = *static_cast<UsbBus*>(self);
    ++(event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED ? bus.arrived_ : bus.left_);
    if (bus.arrivals_ != nullptr) bus.arrivals_->notify();
    return 0;
  };
  const int code = libusb_hotplug_register_callback(
      context_, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
      LIBUSB_HOTPLUG_NO_FLAGS, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
      told, this, &callback_);
  if (code != 0) {
    callback_ = -1;
    return fault("no word of devices that come and go", code);
  }
  stop_ = false;
  // Signals are for the program's other threads.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  Outcome started = success();
  try {
    thread_ = std::thread([this] {
      while (!stop_) {
        timeval most{1, 0};
        libusb_handle_events_timeout_completed(context_, &most, nullptr);
      }
    });
  } catch (const std::system_error&) {
    started = Error{ErrorKind::device, "usb: no thread can be started"};
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (!started) stop_watching();
  return started;
}

void UsbBus::stop_watching() {
  stop_ = true;
  // Also wakes the thread out of its wait.
  if (callback_ >= 0) libusb_hotplug_deregister_callback(context_, callback_);
  callback_ = -1;
  libusb_interrupt_event_handler(context_);
  if (thread_.joinable()) thread_.join();
}

Outcome UsbBus::reset(const UsbDevice& device) const {
  const DeviceList list(context_);
  for (ssize_t i = 0; i < list.count(); ++i) {
    if (libusb_get_bus_number(list.at(i)) != device.bus ||
        libusb_get_device_address(list.at(i)) != device.address)
      continue;
    libusb_device_handle* handle = nullptr;
    int code = libusb_open(list.at(i), &handle);
    if (code == 0) {
      code = libusb_reset_device(handle);
      libusb_close(handle);
    }
    // "Not found" means that the device came back as another one, which is what a reset is for.
    if (code == 0 || code == LIBUSB_ERROR_NOT_FOUND) return success();
    return fault("a port cannot be reset", code);
  }
  return Error{ErrorKind::absent, fmt::format("usb: no device at {}", device.node())};
}

}  // namespace pliant

#include "drivers/openni2/openni2_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "drivers/common/printable.hpp"
#include "drivers/openni2/udev_guard.hpp"

namespace pliant {

namespace {

/// The library's words with one blank where it has blanks, tabs and new lines, and none at the ends.
std::string one_line(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  std::string line;
  for (std::size_t at = text.find_first_not_of(kBlanks); at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    if (!line.empty()) line += ' ';
    line += text.substr(at, end - at);
    at = text.find_first_not_of(kBlanks, end);
  }
  return line;
}

const char* name_of_status(OniStatus status) {
  switch (status) {
    case ONI_STATUS_OK:
      return "ok";
    case ONI_STATUS_NOT_IMPLEMENTED:
      return "not implemented";
    case ONI_STATUS_NOT_SUPPORTED:
      return "not supported";
    case ONI_STATUS_BAD_PARAMETER:
      return "bad parameter";
    case ONI_STATUS_OUT_OF_FLOW:
      return "out of flow";
    case ONI_STATUS_NO_DEVICE:
      return "no device";
    case ONI_STATUS_TIME_OUT:
      return "timeout";
    case ONI_STATUS_ERROR:
      break;
  }
  return "error";
}

}  // namespace

Result<std::shared_ptr<OpenNi2Library>> OpenNi2Library::start(std::shared_ptr<ArrivalSignal> arrivals,
                                                              const OpenNi2Api& api) {
  guard_udev();
  std::shared_ptr<OpenNi2Library> library(new OpenNi2Library(std::move(arrivals), api));
  if (const OniStatus status = api.initialize(ONI_API_VERSION); status != ONI_STATUS_OK)
    return library->fault("the library cannot start", status);
  library->started_ = true;
  OniDeviceCallbacks callbacks{};
  callbacks.deviceConnected = [](const OniDeviceInfo* /*device*/, void* self) {
    static_cast<OpenNi2Library*>(self)->tell();
  };
  callbacks.deviceDisconnected = [](const OniDeviceInfo* device, void* self) {
    static_cast<OpenNi2Library*>(self)->gone(device);
  };
  callbacks.deviceStateChanged = [](const OniDeviceInfo* device, OniDeviceState state, void* self) {
    if (state == ONI_DEVICE_STATE_ERROR) static_cast<OpenNi2Library*>(self)->gone(device);
  };
  if (const OniStatus status = api.register_callbacks(&callbacks, library.get(), &library->callbacks_);
      status != ONI_STATUS_OK) {
    library->callbacks_ = nullptr;
    return library->fault("no word of plugged devices", status);
  }
  return library;
}

namespace {

/// OpenNI2's drivers cancel their threads (libOniFile the one that plays, libPS1080 the one that hears of USB
/// devices, when it is late), and the shutdown then unloads the code that a thread still unwinds through. So
/// they stay loaded.
void keep_drivers_loaded() {
  const auto keep = [](dl_phdr_info* info, std::size_t /*size*/, void* /*unused*/) {
    if (info->dlpi_name != nullptr &&
        std::string_view(info->dlpi_name).find("/OpenNI2/Drivers/") != std::string_view::npos)
      static_cast<void>(dlopen(info->dlpi_name, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE));
    return 0;
  };
  dl_iterate_phdr(keep, nullptr);
}

}  // namespace

OpenNi2Library::~OpenNi2Library() {
  if (callbacks_ != nullptr) api_.unregister_callbacks(callbacks_);
  if (started_) {
    keep_drivers_loaded();
    api_.shutdown();
  }
}

Result<std::vector<OpenNi2Device>> OpenNi2Library::devices() const {
  OniDeviceInfo* list = nullptr;
  int count = 0;
  if (const OniStatus status = api_.get_device_list(&list, &count); status != ONI_STATUS_OK)
    return fault("cannot list devices", status);
  std::vector<OpenNi2Device> devices;
  devices.reserve(static_cast<std::size_t>(count < 0 ? 0 : count));
  for (int i = 0; i < count; ++i)
    devices.push_back({list[i].uri, list[i].vendor, list[i].name, list[i].usbVendorId, list[i].usbProductId});
  static_cast<void>(api_.release_device_list(list));
  return devices;
}

std::shared_ptr<std::atomic<bool>> OpenNi2Library::watch(const std::string& uri) {
  auto flag = std::make_shared<std::atomic<bool>>(false);
  const std::lock_guard lock(mutex_);
  std::erase_if(watches_, [](const Watch& watch) { return watch.gone.expired(); });
  watches_.push_back({uri, flag});
  return flag;
}

void OpenNi2Library::gone(const OniDeviceInfo* device) {
  {
    const std::lock_guard lock(mutex_);
    for (const Watch& watch : watches_)
      if (const auto flag = watch.gone.lock(); flag != nullptr && watch.uri == device->uri) flag->store(true);
  }
  tell();
}

void OpenNi2Library::tell() const {
  if (arrivals_ != nullptr) arrivals_->notify();
}

Error OpenNi2Library::fault(std::string_view what, OniStatus status) const {
  const char* said = api_.extended_error();
  const std::string text = one_line(said == nullptr ? "" : said);
  const ErrorKind kind = status == ONI_STATUS_NO_DEVICE ? ErrorKind::absent : ErrorKind::device;
  return {kind, fmt::format("openni2: {}: {}", what,
                            text.empty() ? std::string(name_of_status(status)) : printable(text, 200))};
}

}  // namespace pliant

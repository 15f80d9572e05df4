#include "drivers/openni2/udev_guard.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <string_view>

struct udev_device;

namespace {

using Function = const char* (*)(udev_device*, const char*);

Function find_real() noexcept {
  // Whoever asks has it loaded.
  void* library = dlopen("libudev.so.1", RTLD_NOW | RTLD_NOLOAD);
  return library == nullptr ? nullptr
                            : reinterpret_cast<Function>(dlsym(library, "udev_device_get_sysattr_value"));
}

/// While it lives, the thread is not cancelled. OpenNI2 cancels the thread that hears of USB devices when it
/// is late, and reading a device's numbers is where cancelling would strike: inside functions that nothing
/// may unwind through, which ends the program.
class NotNow {
 public:
  NotNow() noexcept { pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &before_); }
  NotNow(const NotNow&) = delete;
  NotNow& operator=(const NotNow&) = delete;
  ~NotNow() { pthread_setcancelstate(before_, nullptr); }

 private:
  int before_ = PTHREAD_CANCEL_ENABLE;
};

}  // namespace

/// libudev's function of this name, but for the numbers that OpenNI2 takes to be there.
extern "C" __attribute__((visibility("default"))) const char* udev_device_get_sysattr_value(
    udev_device* device, const char* name) noexcept {
  const NotNow not_now;
  static const Function real = find_real();
  const char* value = real == nullptr ? nullptr : real(device, name);
  constexpr std::array<std::string_view, 4> kTakenForGranted = {"idVendor", "idProduct", "busnum", "devnum"};
  if (value != nullptr || name == nullptr) return value;
  const bool taken =
      std::find(kTakenForGranted.begin(), kTakenForGranted.end(), name) != kTakenForGranted.end();
  return taken ? "0" : nullptr;
}

namespace pliant {

void guard_udev() noexcept {}

}  // namespace pliant

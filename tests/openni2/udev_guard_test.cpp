// The program's own udev_device_get_sysattr_value, which goes before libudev's.
#include "drivers/openni2/udev_guard.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <fstream>
#include <string>

struct udev;
struct udev_device;
extern "C" const char* udev_device_get_sysattr_value(udev_device* device, const char* name);

namespace pliant {
namespace {

class UdevGuard : public testing::Test {
 protected:
  template <typename Function>
  Function find(const char* name) const {
    return reinterpret_cast<Function>(dlsym(library_, name));
  }
  void* library_ = dlopen("libudev.so.1", RTLD_NOW);
};

TEST_F(UdevGuard, IsWhatADriverFinds) {
  guard_udev();
  EXPECT_EQ(dlsym(RTLD_DEFAULT, "udev_device_get_sysattr_value"),
            reinterpret_cast<void*>(&udev_device_get_sysattr_value));
}

TEST_F(UdevGuard, ADeviceThatIsGoneHasNumbersOfZero) {
  for (const char* name : {"idVendor", "idProduct", "busnum", "devnum"})
    EXPECT_STREQ(udev_device_get_sysattr_value(nullptr, name), "0");
  EXPECT_EQ(udev_device_get_sysattr_value(nullptr, "manufacturer"), nullptr);
  EXPECT_EQ(udev_device_get_sysattr_value(nullptr, nullptr), nullptr);
}

TEST_F(UdevGuard, WhatIsThereIsToldAsItIs) {
  ASSERT_NE(library_, nullptr);
  udev* context = find<udev* (*)()>("udev_new")();
  udev_device* device = find<udev_device* (*)(udev*, const char*)>("udev_device_new_from_syspath")(
      context, "/sys/class/net/lo");
  if (device == nullptr) GTEST_SKIP() << "no /sys/class/net/lo here";
  std::string mtu;
  std::ifstream("/sys/class/net/lo/mtu") >> mtu;
  EXPECT_EQ(udev_device_get_sysattr_value(device, "mtu"), mtu);
  EXPECT_EQ(udev_device_get_sysattr_value(device, "no_such_thing"), nullptr);
  find<udev_device* (*)(udev_device*)>("udev_device_unref")(device);
  find<udev* (*)(udev*)>("udev_unref")(context);
}

/// OpenNI2 cancels its USB thread when that is late.
TEST_F(UdevGuard, AThreadThatIsCancelledMeanwhileEndsAfterwards) {
  ASSERT_NE(library_, nullptr);
  udev* context = find<udev* (*)()>("udev_new")();
  udev_device* device = find<udev_device* (*)(udev*, const char*)>("udev_device_new_from_syspath")(
      context, "/sys/class/net/lo");
  if (device == nullptr) GTEST_SKIP() << "no /sys/class/net/lo here";
  struct Asked {
    udev_device* device = nullptr;
    std::string mtu;
  } asked{device, {}};
  pthread_t thread{};
  ASSERT_EQ(pthread_create(
                &thread, nullptr,
                [](void* given) -> void* {
                  auto& of = *static_cast<Asked*>(given);
                  pthread_cancel(pthread_self());  // strikes where the thread next reads a file
                  const char* mtu = udev_device_get_sysattr_value(of.device, "mtu");
                  if (mtu != nullptr) of.mtu = mtu;
                  pthread_testcancel();
                  return nullptr;
                },
                &asked),
            0);
  void* ended = nullptr;
  pthread_join(thread, &ended);
  EXPECT_EQ(ended, PTHREAD_CANCELED);
  EXPECT_FALSE(asked.mtu.empty());
  find<udev_device* (*)(udev_device*)>("udev_device_unref")(device);
  find<udev* (*)(udev*)>("udev_unref")(context);
}

}  // namespace
}  // namespace pliant

// The real libusb on an emulated bus (umockdev): what is there, and word of what comes and goes.
#include "drivers/usb/usb_bus.hpp"

#include <gtest/gtest.h>
#include <umockdev.h>

#include <chrono>
#include <filesystem>

namespace pliant {
namespace {

// A Structure Sensor at a high-speed port.
constexpr const char* kSensor =
    "P: /devices/usb1\nN: bus/usb/001/001\nE: DEVNAME=/dev/bus/usb/001/001\nE: DEVTYPE=usb_device\n"
    "E: SUBSYSTEM=usb\nE: BUSNUM=001\nE: DEVNUM=001\nA: busnum=1\\n\nA: devnum=1\\n\nA: speed=480\\n\n"
    "A: bConfigurationValue=1\\n\n"
    "H: "
    "descriptors="
    "1201000200000040271D00060001010203010902190001010080FA0904000001FF000000070581020002000C\n\n";

class Bus : public testing::Test {
 protected:
  Bus() : testbed_(umockdev_testbed_new()) {}
  ~Bus() override { g_object_unref(testbed_); }
  void plug() {
    GError* error = nullptr;
    ASSERT_TRUE(umockdev_testbed_add_from_string(testbed_, kSensor, &error)) << error->message;
  }
  UMockdevTestbed* testbed_;
};

TEST_F(Bus, ListsWhatIsPluggedIn) {
  {
    const auto bus = UsbBus::open();
    ASSERT_TRUE(bus) << bus.error().message;
    const auto none = (*bus)->devices();
    ASSERT_TRUE(none) << none.error().message;
    EXPECT_TRUE(none->empty());
  }
  plug();
  const auto bus = UsbBus::open();
  ASSERT_TRUE(bus);
  const auto devices = (*bus)->devices();
  ASSERT_TRUE(devices);
  ASSERT_EQ(devices->size(), 1U);
  const UsbDevice& device = devices->front();
  EXPECT_EQ(device.vendor, 0x1d27);
  EXPECT_EQ(device.product, 0x0600);
  EXPECT_EQ(device.megabits, 480);
  EXPECT_EQ(device.node(), "/dev/bus/usb/001/001");
  EXPECT_EQ(device.classes, std::vector<int>{255});
  EXPECT_TRUE(device.accessible);
  EXPECT_FALSE(device.in_use);
}

TEST_F(Bus, KnowsThatAProgramHasADevice) {
  plug();
  GError* error = nullptr;
  std::string camera = kSensor;  // another one, at port 2 of the first
  for (const auto& [of_first, of_camera] : {std::pair{"/devices/usb1", "/devices/usb1/1-2"},
                                            {"001/001", "001/002"},
                                            {"001/001", "001/002"},
                                            {"DEVNUM=001", "DEVNUM=002"},
                                            {"devnum=1", "devnum=2"}})
    camera.replace(camera.find(of_first), std::string(of_first).size(), of_camera);
  camera +=
      "P: /devices/usb1/1-2/1-2:1.0\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\n"
      "L: driver=../../../../bus/usb/drivers/usbfs\n\n";
  ASSERT_TRUE(umockdev_testbed_add_from_string(testbed_, camera.c_str(), &error)) << error->message;
  const auto bus = UsbBus::open();
  ASSERT_TRUE(bus);
  const auto devices = (*bus)->devices();
  ASSERT_TRUE(devices);
  ASSERT_EQ(devices->size(), 2U);
  EXPECT_FALSE(devices->front().in_use);
  EXPECT_EQ(devices->back().port, "1-2");
  EXPECT_TRUE(devices->back().in_use);
}

TEST_F(Bus, TellsWhatComesAndGoes) {
  const auto bus = UsbBus::open();
  ASSERT_TRUE(bus);
  auto arrivals = std::make_shared<ArrivalSignal>();
  const Outcome watched = (*bus)->watch(arrivals);
  ASSERT_TRUE(watched) << watched.error().message;
  const auto told_of = [&](const auto& action) {
    const std::uint64_t seen = arrivals->events();
    action();
    EXPECT_TRUE(arrivals->wait(seen, std::chrono::seconds(30)));
  };
  told_of([this] { plug(); });
  EXPECT_EQ((*bus)->arrived(), 1U);
  told_of([this] { umockdev_testbed_uevent(testbed_, "/sys/devices/usb1", "remove"); });
  EXPECT_EQ((*bus)->left(), 1U);
  told_of([this] { umockdev_testbed_uevent(testbed_, "/sys/devices/usb1", "add"); });
  EXPECT_EQ((*bus)->arrived(), 2U);
}

TEST_F(Bus, OpenedAndClosedOftenKeepsNothing) {
  plug();
  const auto arrivals = std::make_shared<ArrivalSignal>();
  const auto cycle = [&arrivals] {
    const auto bus = UsbBus::open();
    ASSERT_TRUE(bus) << bus.error().message;
    ASSERT_TRUE((*bus)->watch(arrivals));
    EXPECT_EQ((*bus)->devices()->size(), 1U);
  };
  const auto entries = [](const char* folder) {
    return std::distance(std::filesystem::directory_iterator(folder), {});
  };
  for (int i = 0; i < 5; ++i) cycle();
  const auto descriptors = entries("/proc/self/fd"), threads = entries("/proc/self/task");
  for (int i = 0; i < 50; ++i) cycle();
  EXPECT_EQ(entries("/proc/self/fd"), descriptors);
  EXPECT_EQ(entries("/proc/self/task"), threads);
}

TEST_F(Bus, ResettingWhatIsNotThereIsAnError) {
  const auto bus = UsbBus::open();
  ASSERT_TRUE(bus);
  UsbDevice gone;
  gone.bus = 1;
  gone.address = 9;
  const Outcome reset = (*bus)->reset(gone);
  ASSERT_FALSE(reset);
  EXPECT_EQ(reset.error().kind, ErrorKind::absent);
}

}  // namespace
}  // namespace pliant

// A Structure Sensor on the bus, as OpenNI2's own driver (PS1080) sees it.
#include "tests/vm/structure_sensor.hpp"

#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <thread>

#include "drivers/openni2/openni2_library.hpp"
#include "drivers/usb/usb_bus.hpp"
#include "firmware-app/measure/clock.hpp"
#include "tests/vm/guest.hpp"

namespace pliant::test {
namespace {

/// Has the first interface of the device of this vendor, as programs that use libusb do.
class AnotherProgram {
 public:
  explicit AnotherProgram(std::uint16_t vendor) {
    const auto bus = UsbBus::open();
    const auto devices = bus ? (*bus)->devices() : Result<std::vector<UsbDevice>>(bus.error());
    for (const UsbDevice& device : devices ? *devices : std::vector<UsbDevice>())
      if (device.vendor == vendor) file_ = open(device.node().c_str(), O_RDWR | O_CLOEXEC);
    unsigned interface = 0;
    EXPECT_EQ(ioctl(file_, USBDEVFS_CLAIMINTERFACE, &interface), 0) << errno;
  }
  ~AnotherProgram() { close(file_); }
  AnotherProgram(const AnotherProgram&) = delete;
  AnotherProgram& operator=(const AnotherProgram&) = delete;

 private:
  int file_ = -1;
};

class StructureSensorTest : public CommandTest {
 protected:
  StructureSensor sensor_;
};

TEST_F(StructureSensorTest, OpenNi2SeesItComeAndGo) {
  auto arrivals = std::make_shared<ArrivalSignal>();
  const auto library = OpenNi2Library::start(arrivals);
  ASSERT_TRUE(library) << library.error().message;
  const auto listed = [&] {
    const auto devices = (*library)->devices();
    return devices ? *devices : std::vector<OpenNi2Device>();
  };
  EXPECT_TRUE(listed().empty());
  for (int round = 0; round < 2; ++round) {
    const std::uint64_t seen = arrivals->events();
    ASSERT_EQ(sensor_.plug(kPort), "");
    EXPECT_TRUE(arrivals->wait(seen, std::chrono::seconds(10))) << "the driver tells nothing of it";
    EXPECT_TRUE(wait_until(5, [&] { return listed().size() == 1; }));
    const auto devices = listed();
    ASSERT_EQ(devices.size(), 1U);
    EXPECT_EQ(devices.front().vendor_id, 0x1d27);
    EXPECT_EQ(devices.front().product_id, 0x0600);
    EXPECT_TRUE(devices.front().uri.starts_with("1d27/0600@")) << devices.front().uri;
    const auto gone = (*library)->watch(devices.front().uri);
    EXPECT_FALSE(*gone);
    sensor_.unplug();
    EXPECT_TRUE(wait_until(10, [&] { return gone->load(); })) << "the driver does not tell that it went";
    EXPECT_TRUE(wait_until(5, [&] { return listed().empty(); }));
  }
}

TEST_F(StructureSensorTest, ADeviceThatIsGoneBeforeItIsLookedAtHarmsNothing) {
  std::thread loose_cable([this] {
    for (int i = 0; i < 12 && sensor_.plug(kPort).empty(); ++i) {
      usleep(100'000);  // the kernel needs longer to ask it what it is
      sensor_.unplug();
    }
  });
  {
    const auto library = OpenNi2Library::start();
    EXPECT_TRUE(library) << library.error().message;
    EXPECT_EQ(run_pliant({"devices"}).code, 0);
  }
  loose_cable.join();
}

TEST_F(StructureSensorTest, OurUdevRulesGiveItToTheGroupVideo) {
  const auto bus = UsbBus::open();
  ASSERT_TRUE(bus) << bus.error().message;
  const group* video = getgrnam("video");  // NOLINT(concurrency-mt-unsafe)
  ASSERT_NE(video, nullptr);
  ASSERT_EQ(sensor_.plug(kPort), "");
  std::string node;
  struct stat about {};
  EXPECT_TRUE(wait_until(10,
                         [&] {
                           const auto devices = (*bus)->devices();
                           for (const UsbDevice& device : devices ? *devices : std::vector<UsbDevice>())
                             if (device.vendor == 0x1d27) node = device.node();
                           return stat(node.c_str(), &about) == 0 && about.st_gid == video->gr_gid &&
                                  (about.st_mode & 0777U) == 0660;
                         }))
      << node << ": group " << about.st_gid << ", mode " << std::oct << (about.st_mode & 0777U);
  sensor_.unplug();
}

TEST_F(StructureSensorTest, DevicesNamesIt) {
  ASSERT_EQ(sensor_.plug(kPort), "");
  std::string told;
  EXPECT_TRUE(wait_until(20, [&told] {
    told = run_pliant({"devices"}).out;
    return told.find("sources:\nopenni2:1d27/0600@") != std::string::npos;
  })) << told;
  EXPECT_NE(told.find("its description is config/sensors/structure_sensor.toml"), std::string::npos) << told;
  {
    const AnotherProgram other(0x1d27);
    const std::string busy = run_pliant({"devices"}).out;
    EXPECT_NE(busy.find("another program uses it ('fuser /dev/bus/usb/"), std::string::npos) << busy;
    EXPECT_EQ(busy.find("sources:"), std::string::npos) << busy;
  }
  sensor_.unplug();
  EXPECT_TRUE(wait_until(20, [&told] {
    told = run_pliant({"devices"}).out;
    return told.find("no depth device is seen") != std::string::npos;
  })) << told;
}

TEST_F(StructureSensorTest, OneThatDoesNotAnswerIsAnErrorInTime) {
  ASSERT_EQ(sensor_.plug(kPort), "");
  const std::int64_t begin = monotonic_ns();
  const Ended ended = run_pliant({"run", "--source", "openni2:", "--model", kModel, "--lcm-url", "none"});
  EXPECT_LT(monotonic_ns() - begin, 60'000'000'000);
  expect_refused(ended, 3, {"openni2"});
  sensor_.unplug();
}

}  // namespace
}  // namespace pliant::test

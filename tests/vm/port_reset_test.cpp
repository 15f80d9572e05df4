// A camera whose firmware hangs comes back when its port is reset.
#include <gtest/gtest.h>

#include "drivers/usb/usb_place.hpp"
#include "tests/vm/guest.hpp"
#include "tests/vm/uvc_camera.hpp"

namespace pliant::test {
namespace {

class PortReset : public CommandTest {
 protected:
  void SetUp() override {
    ASSERT_EQ(camera_.plug(kPort), "");
    ASSERT_TRUE(wait_until(10, [] { return !depth_node(kBus).path.empty(); }));
  }
  void TearDown() override {
    camera_.unplug();
    static_cast<void>(wait_until(5, [] { return depth_node(kBus).path.empty(); }));
  }
  UvcCamera camera_{
      0x8086, 0x0b07, {recorded().camera.width, recorded().camera.height, 10}, recorded().pictures};
};

TEST_F(PortReset, TheKernelDoesIt) {
  const auto bus = UsbBus::open();
  ASSERT_TRUE(bus) << bus.error().message;
  camera_.hang();
  const int before = camera_.configurations();
  EXPECT_GE(before, 1);
  const auto devices = (*bus)->devices();
  ASSERT_TRUE(devices) << devices.error().message;
  const UsbDevice* device = find_at_place(*devices, kBus);
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(device->vendor, 0x8086);
  const Outcome reset = (*bus)->reset(*device);
  EXPECT_TRUE(reset) << reset.error().message;
  EXPECT_EQ(camera_.configurations(), before + 1);
  EXPECT_FALSE(camera_.hung());
  // Only what was meant.
  UsbDevice elsewhere = *device;
  elsewhere.address += 50;
  const Outcome other = (*bus)->reset(elsewhere);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().kind, ErrorKind::absent);
}

TEST_F(PortReset, IsTheProgramsLastResort) {
  Tracking tracking(folder_, std::string("v4l2:") + kBus, 10);
  const auto tracks = [](const StatusMessage& status) { return status.state == TrackState::tracking; };
  ASSERT_TRUE(tracking.until(60, tracks)) << tracking.told();
  camera_.hang();
  const int before = camera_.configurations();
  EXPECT_TRUE(tracking.until(40, [this](const StatusMessage& status) {
    return !camera_.hung() && status.device == DeviceState::streaming;
  })) << tracking.told();
  EXPECT_EQ(camera_.configurations(), before + 1);
  const std::int64_t tracked = tracking.latest().tracked;
  EXPECT_TRUE(tracking.until(60, [&](const StatusMessage& status) {
    return tracks(status) && status.tracked > tracked + 10;
  })) << tracking.told();
  EXPECT_NE(tracking.states().find(" stalled"), std::string::npos) << tracking.states();
  EXPECT_EQ(tracking.stop().code, 0);
}

}  // namespace
}  // namespace pliant::test

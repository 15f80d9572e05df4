// Live devices through the real libOpenNI2.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <ctime>

#include "drivers/openni2/openni2.hpp"
#include "tests/openni2/sensor_rig.hpp"

namespace pliant::test {
namespace {

class Device : public testing::Test {
 protected:
  Result<std::unique_ptr<DepthSource>> open(const SourceWish& wish = {}, std::string_view uri = "") {
    auto library = OpenNi2Library::start();
    if (!library) return library.error();
    return open_openni2(*library, uri, wish);
  }
  void expect_refused(std::string_view part, const SourceWish& wish = {}) {
    const auto source = open(wish);
    ASSERT_FALSE(source);
    EXPECT_EQ(source.error().kind, ErrorKind::device);
    EXPECT_NE(source.error().message.find(part), std::string::npos) << source.error().message;
  }
  SensorRig rig_;
};

TEST_F(Device, TheLibrarysWordsBecomeOneLine) {
  OpenNi2Api api;
  api.device_open = [](const char* /*uri*/, OniDeviceHandle* /*device*/) { return ONI_STATUS_ERROR; };
  api.extended_error = [] { return "\tCould not open it:\r\n\t\tno answer!\n"; };
  auto library = OpenNi2Library::start(nullptr, api);
  ASSERT_TRUE(library) << library.error().message;
  const auto source = open_openni2(*library, "", {});
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().message, "openni2: cannot open virtual/sensor@1/7: Could not open it: no answer!");
}

TEST_F(Device, StreamsItsFramesUnmirroredWithItsCamera) {
  auto source = open();
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_TRUE((*source)->live());
  EXPECT_EQ((*source)->rate(), 30);
  const Intrinsics& camera = (*source)->intrinsics();
  EXPECT_EQ(camera.width, 320);
  EXPECT_NEAR(camera.fx, 285, 0.01);
  EXPECT_NEAR(camera.fy, 285, 0.01);
  EXPECT_EQ(camera.cx, 159.5);
  EXPECT_EQ(camera.cy, 119.5);
  EXPECT_EQ(camera.depth_scale, 1000);
  SourceItem item;
  std::int64_t before = 0, number = -1;
  for (int i = 0; i < 10; ++i) {
    (*source)->next(1000, item);
    ASSERT_EQ(item.event, SourceEvent::frame) << item.fault;
    EXPECT_GT(item.frame.number, number);
    number = item.frame.number;
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    const std::int64_t age = std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000 - item.frame.utime;
    EXPECT_GE(age, 0);
    EXPECT_LT(age, 500'000);
    EXPECT_GT(item.frame.utime, before);
    before = item.frame.utime;
  }
  (*source)->next(1000, item);
  ASSERT_EQ(item.event, SourceEvent::frame);
  bool known = false;
  for (int i = 0; i < 20 && !known; ++i)
    known = std::memcmp(item.frame.depth, rig_.frame(i), 320 * 240 * 2) == 0;
  EXPECT_TRUE(known) << "the very bytes of one of the frames";
}

TEST_F(Device, ADescriptionChoosesTheModeAndTheCamera) {
  SourceWish wish;
  wish.camera = Intrinsics{320, 240, 290, 291, 160, 121, 500};
  wish.sensor.noise_floor = 0.002;
  const auto source = open(wish);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->intrinsics().fy, 291);
  EXPECT_EQ((*source)->intrinsics().depth_scale, 1000) << "the unit is the mode's";
  EXPECT_EQ((*source)->sensor().noise_floor, 0.002);
  wish.camera->width = 1280;
  wish.camera->height = 1024;
  expect_refused("no depth mode of 1280x1024; the device has 160x120 at 30 Hz, 320x240 at 30 Hz", wish);
}

TEST_F(Device, WhatItWillNotSetIsAnError) {
  rig_.control().fault = SensorFault::keeps_mirror;
  expect_refused("mirroring cannot be switched off");
  rig_.control().fault = SensorFault::keeps_registration;
  expect_refused("registration to colour stays on");
  rig_.control().fault = SensorFault::other_mode;
  expect_refused("took 160x240");
  rig_.control().fault = SensorFault::no_start;
  expect_refused("does not start");
  rig_.control().fault = SensorFault::none;
  rig_.control().field_of_view_across = 0;
  expect_refused("field of view");
}

TEST_F(Device, WithoutOneItIsAbsent) {
  rig_.control().plugged = 0;
  const auto source = open();
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().kind, ErrorKind::absent);
  EXPECT_NE(source.error().message.find("pliant devices"), std::string::npos);
}

TEST_F(Device, IsFoundByItsUriAndByItsPlaceWhenTheNumberIsNew) {
  EXPECT_TRUE(open({}, "virtual/sensor@1/7"));
  EXPECT_TRUE(open({}, "virtual/sensor@1/3"));
  const auto other = open({}, "virtual/sensor@2/7");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().kind, ErrorKind::absent);
  EXPECT_NE(other.error().message.find("virtual/sensor@2/7"), std::string::npos);
}

TEST_F(Device, FramesThatNobodyFetchedKeepTheirNumbers) {
  rig_.control().rate = 100;
  auto source = open();
  ASSERT_TRUE(source) << source.error().message;
  SourceItem item;
  (*source)->next(1000, item);
  ASSERT_EQ(item.event, SourceEvent::frame);
  EXPECT_EQ(item.frame.number, 0);
  const std::int32_t sent = rig_.control().sent;
  while (rig_.control().sent < sent + 20) usleep(1000);
  std::int64_t last = 0;
  for (int i = 0; i < 3; ++i) {
    (*source)->next(1000, item);
    ASSERT_EQ(item.event, SourceEvent::frame);
    last = item.frame.number;
  }
  EXPECT_GE(last, 18) << "the library holds the latest alone";
}

TEST_F(Device, SilenceIsATimeoutAndUnpluggingALoss) {
  auto source = open();
  ASSERT_TRUE(source) << source.error().message;
  SourceItem item;
  (*source)->next(1000, item);
  ASSERT_EQ(item.event, SourceEvent::frame);
  rig_.control().fault = SensorFault::silent;
  (*source)->next(60, item);
  for (int i = 0; i < 5 && item.event == SourceEvent::frame; ++i) (*source)->next(60, item);
  EXPECT_EQ(item.event, SourceEvent::timeout);
  rig_.control().plugged = 0;
  for (int i = 0; i < 50 && item.event != SourceEvent::lost; ++i) (*source)->next(20, item);
  EXPECT_EQ(item.event, SourceEvent::lost);
  EXPECT_NE(item.fault, "");
}

TEST_F(Device, FramesThatAreNotWholeAreBad) {
  auto source = open();
  ASSERT_TRUE(source) << source.error().message;
  rig_.control().fault = SensorFault::cut;
  SourceItem item;
  for (int i = 0; i < 10; ++i) {
    (*source)->next(1000, item);
    if (item.event == SourceEvent::bad_frame) break;
  }
  EXPECT_EQ(item.event, SourceEvent::bad_frame);
  EXPECT_NE(item.fault.find("100 bytes"), std::string::npos) << item.fault;
}

}  // namespace
}  // namespace pliant::test

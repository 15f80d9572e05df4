// A depth camera of the video class through the kernel's own uvcvideo.
#include "tests/vm/uvc_camera.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

#include "drivers/usb/usb_bus.hpp"
#include "drivers/v4l2/v4l2.hpp"
#include "tests/vm/guest.hpp"

namespace pliant::test {
namespace {

constexpr std::uint16_t kVendor = 0x8086, kProduct = 0x0b07;  // a RealSense D435, which this driver serves
constexpr int kRate = 10;                                     // frames a second
constexpr double kMostError = 0.004;  // metres; a pixel of these pictures is 3 mm wide where the object is
constexpr long kMovedPages = 10;      // the kernel moves a page now and then, which faults it once
const std::string kSource = std::string("v4l2:") + kBus;

/// Behind "key": in a file of --stats; -1 where there is none.
long number_of(const std::string& stats, const std::string& key) {
  const std::string before = '"' + key + "\": ";
  const std::size_t at = stats.find(before);
  return at == std::string::npos ? -1 : std::strtol(stats.c_str() + at + before.size(), nullptr, 10);
}

class UvcCameraTest : public CommandTest {
 protected:
  ~UvcCameraTest() override {
    camera_.unplug();
    // The next test must not find this camera's node.
    static_cast<void>(wait_until(5, [] { return depth_node(kBus).path.empty(); }));
  }
  void plug() {
    const std::string fault = camera_.plug(kPort);
    ASSERT_EQ(fault, "");
    ASSERT_TRUE(wait_until(10, [] { return !depth_node(kBus).path.empty(); }))
        << "uvcvideo makes no node for the camera";
  }
  UvcCamera camera_{
      kVendor, kProduct, {recorded().camera.width, recorded().camera.height, kRate}, recorded().pictures};
};

TEST_F(UvcCameraTest, TheKernelsUsbEventsReachUs) {
  const auto bus = UsbBus::open();
  ASSERT_TRUE(bus) << bus.error().message;
  auto arrivals = std::make_shared<ArrivalSignal>();
  const Outcome watched = (*bus)->watch(arrivals);
  ASSERT_TRUE(watched) << watched.error().message;
  for (int round = 0; round < 2; ++round) {
    plug();
    EXPECT_TRUE(wait_until(5, [&] { return (*bus)->arrived() == static_cast<std::uint64_t>(round) + 1; }))
        << (*bus)->arrived() << " arrivals in round " << round;
    const auto devices = (*bus)->devices();
    ASSERT_TRUE(devices) << devices.error().message;
    bool listed = false;
    for (const UsbDevice& device : *devices)
      listed = listed || (device.vendor == kVendor && device.product == kProduct && device.megabits == 480);
    EXPECT_TRUE(listed);
    camera_.unplug();
    EXPECT_TRUE(wait_until(5, [&] { return (*bus)->left() == static_cast<std::uint64_t>(round) + 1; }))
        << (*bus)->left() << " departures in round " << round;
  }
  EXPECT_GE(arrivals->events(), 4U);
}

TEST_F(UvcCameraTest, DevicesNamesIt) {
  EXPECT_EQ(run_pliant({"devices"}).out.find(kBus), std::string::npos);
  plug();
  const Ended ended = run_pliant({"devices"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("v4l2:/dev/video0"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("Depth camera"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find(std::string(kBus) + ", Z16"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("RealSense D435: is connected by USB 2 (480 Mbit/s)"), std::string::npos)
      << ended.out;
}

TEST_F(UvcCameraTest, EveryReadingArrivesAsItWasSent) {
  plug();
  SourceWish wish;
  wish.camera = recorded().camera;
  wish.rate = kRate;
  const auto source = open_v4l2({kBus, "Z16"}, wish);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->rate(), kRate);
  SourceItem item;
  std::int64_t before = 0;
  const auto pictures = static_cast<std::int64_t>(recorded().pictures.size());
  for (std::int64_t i = 0; i < 20; ++i) {
    (*source)->next(3000, item);
    ASSERT_EQ(item.event, SourceEvent::frame) << i << ": " << item.fault;
    EXPECT_GT(item.frame.utime, before);
    before = item.frame.utime;
    ASSERT_LT(item.frame.number, pictures);
    const auto& sent = recorded().pictures[static_cast<std::size_t>(item.frame.number)];
    ASSERT_EQ(item.frame.stride, recorded().camera.width);
    EXPECT_EQ(std::memcmp(item.frame.depth, sent.data(), 2 * sent.size()), 0) << "frame " << i;
  }
}

TEST_F(UvcCameraTest, TheObjectIsFollowedAndFoundAgainAfterTheCableWasPulled) {
  plug();
  Tracking tracking(folder_, kSource, kRate);
  const auto tracks = [](const StatusMessage& status) { return status.state == TrackState::tracking; };
  ASSERT_TRUE(tracking.until(60, tracks)) << tracking.told();
  const double rate = tracking.rate_within(60);
  printf("[          ] %.1f frames a second tracked, each %d us from capture to publishing\n", rate,
         tracking.latest().latency_median);
  EXPECT_GE(rate, kLeastRate) << tracking.told();
  printf("[          ] %.1f mm off its place in the median\n", 1000 * tracking.median_error());
  EXPECT_LT(tracking.median_error(), kMostError) << tracking.told();

  // Who comes second is told so.
  EXPECT_NE(run_pliant({"devices"}).out.find("another program uses it ('fuser /dev/video0' tells which)"),
            std::string::npos);
  expect_refused(
      run_pliant({"record", "--source", kSource, "--sensor", at("sensor.toml"), "-o", at("second")}), 3,
      {"/dev/video0", "another program uses it"});

  camera_.unplug();
  EXPECT_TRUE(tracking.until(5, [](const StatusMessage& status) {
    return status.device == DeviceState::absent;
  })) << tracking.told();
  EXPECT_FALSE(tracks(tracking.latest()) && tracking.latest().device == DeviceState::streaming);
  sleep(3);  // by now it looks only once a second by itself
  const std::int64_t tracked = tracking.latest().tracked;
  plug();
  EXPECT_TRUE(tracking.until(5, [](const StatusMessage& status) {
    return status.device == DeviceState::streaming;
  })) << tracking.told();
  EXPECT_TRUE(tracking.until(60, [&](const StatusMessage& status) {
    return tracks(status) && status.tracked >= tracked + 20;
  })) << tracking.told();
  EXPECT_EQ(tracking.latest().reopenings, 1) << tracking.told();
  const std::string states = tracking.states();
  EXPECT_NE(states.find(" absent"), std::string::npos) << states;
  EXPECT_TRUE(states.ends_with(" streaming")) << states;
  const Ended ended = tracking.stop();
  EXPECT_EQ(ended.code, 0) << ended.err;
  const std::string stats = read_file(folder_ / "stats.json");
  EXPECT_EQ(number_of(stats, "heap_calls_after_start"), 0) << stats;
  EXPECT_LE(number_of(stats, "page_faults_after_start"), kMovedPages) << stats;
}

}  // namespace
}  // namespace pliant::test

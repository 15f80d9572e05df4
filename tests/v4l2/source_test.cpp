// The V4L2 driver on a kernel that the test plays.
#include <gtest/gtest.h>
#include <malloc.h>
#include <poll.h>

#include <cerrno>

#include "drivers/v4l2/v4l2.hpp"
#include "tests/v4l2/fake_kernel.hpp"

namespace pliant::test {
namespace {

SourceWish wish(int width = 64, int height = 48) {
  SourceWish wish;
  wish.camera = Intrinsics{width, height, 60, 60, 31.5, 23.5, 1000};
  return wish;
}

struct Rig {
  Rig() { kernel.picture.resize(64 * 48 * 2, std::byte{3}); }
  Result<std::unique_ptr<DepthSource>> open(const V4l2Address& address = {}) {
    return open_v4l2(address, wish(), kernel);
  }
  void start(const V4l2Address& address = {}) {
    auto opened = open(address);
    ASSERT_TRUE(opened) << opened.error().message;
    source = std::move(*opened);
  }
  void next(int timeout_ms = 50) { source->next(timeout_ms, item); }
  void expect_refused(ErrorKind kind, std::string_view part, const V4l2Address& address = {}) {
    const auto opened = open(address);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().kind, kind);
    EXPECT_NE(opened.error().message.find(part), std::string::npos) << opened.error().message;
    EXPECT_EQ(kernel.open_files, 0);
    EXPECT_EQ(kernel.maps, 0);
  }
  FakeKernel kernel;
  std::unique_ptr<DepthSource> source;
  SourceItem item;
};

class Planes : public testing::TestWithParam<bool> {};

TEST_P(Planes, FramesComeWithNumbersAndStampsFromTheKernelsMemory) {
  Rig rig;
  rig.kernel.multi_planar = GetParam();
  rig.kernel.padding = 6;
  rig.kernel.frame_us = 66'666;
  rig.start();
  EXPECT_TRUE(rig.source->live());
  EXPECT_EQ(rig.source->rate(), 15) << "as the driver set it";
  for (int i = 0; i < 12; ++i) {
    rig.next(100);
    ASSERT_EQ(rig.item.event, SourceEvent::frame) << rig.item.fault;
    EXPECT_EQ(rig.item.frame.number, i);
    EXPECT_EQ(rig.item.frame.width, 64);
    EXPECT_EQ(rig.item.frame.stride, 67);
    EXPECT_EQ(rig.item.frame.depth[0], 0x0303);
    EXPECT_EQ(rig.kernel.wall_us() - rig.item.frame.utime, 500);
    if (i == 6) rig.kernel.wall_offset_us += 3'600'000'000;  // the clock is set: stamps follow at once
  }
  rig.source->close();
  rig.next();
  EXPECT_EQ(rig.item.event, SourceEvent::end);
  EXPECT_EQ(rig.kernel.open_files, 0);
  EXPECT_EQ(rig.kernel.maps, 0);
}
INSTANTIATE_TEST_SUITE_P(V4l2, Planes, testing::Bool(),
                         [](const auto& about) { return about.param ? "multi" : "single"; });

TEST(V4l2Source, PackedFormatsAreUnpacked) {
  Rig rig;
  rig.kernel.formats = {v4l2_fourcc('Y', '1', '2', 'P')};
  rig.start();
  rig.next();
  ASSERT_EQ(rig.item.event, SourceEvent::frame) << rig.item.fault;
  EXPECT_EQ(rig.item.frame.depth[0], 0x033);
  EXPECT_EQ(rig.item.frame.depth[1], 0x030);
  EXPECT_EQ(rig.item.frame.stride, 64);
}

TEST(V4l2Source, DevicesAreFoundByWhatTheyOffer) {
  Rig rig;
  rig.start({"", ""});
  rig.source.reset();
  rig.start({"usb-0000:00:14.0-2", ""});
  rig.source.reset();
  rig.start({"/dev/video2", "Z16"});
  rig.source.reset();
  rig.expect_refused(ErrorKind::absent, "usb-9", {"usb-9", ""});
  rig.expect_refused(ErrorKind::absent, "No such file", {"/dev/video9", ""});
  rig.expect_refused(ErrorKind::device, "offers no Y16; it has YUYV, Z16", {"/dev/video2", "Y16"});
  rig.kernel.formats = {V4L2_PIX_FMT_YUYV};
  rig.expect_refused(ErrorKind::device, "offers no depth format; it has YUYV", {"/dev/video2", ""});
  rig.expect_refused(ErrorKind::absent, "no video device offers depth");
  rig.kernel.is_capture = false;
  rig.expect_refused(ErrorKind::bad_input, "delivers no pictures", {"/dev/video2", ""});
}

TEST(V4l2Source, TheFormatAskedForChoosesAmongTheNodesOfACamera) {
  Rig rig;
  rig.kernel.other_formats = {V4L2_PIX_FMT_Y16};  // infrared, on the node that comes first
  rig.start({"", "Z16"});
  rig.next();
  EXPECT_EQ(rig.item.event, SourceEvent::frame) << rig.item.fault;
  rig.source.reset();
  rig.start({"usb-0000:00:14.0-2", "Z16"});
  rig.source.reset();
  rig.expect_refused(ErrorKind::device, "offers no INZI; it has YUYV, Z16", {"usb-0000:00:14.0-2", "INZI"});
}

TEST(V4l2Source, AFrameThatWasFetchedLateKeepsItsStampHoweverLate) {
  Rig rig;
  rig.start();
  rig.next();
  ASSERT_EQ(rig.item.event, SourceEvent::frame) << rig.item.fault;
  rig.kernel.now_us += 15'000'000;  // the program was stopped, the kernel's buffers were full
  rig.next();
  ASSERT_EQ(rig.item.event, SourceEvent::frame) << rig.item.fault;
  EXPECT_GT(rig.kernel.wall_us() - rig.item.frame.utime, 14'900'000);
}

TEST(V4l2Source, StampsOfAnotherClockAreNotTaken) {
  Rig rig;
  rig.start();
  rig.kernel.stamp_offset_us = -900'000'000;  // the camera's own, which began a while ago
  for (int i = 0; i < 3; ++i) {
    rig.next();
    ASSERT_EQ(rig.item.event, SourceEvent::frame) << rig.item.fault;
    EXPECT_EQ(rig.item.frame.utime, rig.kernel.wall_us());
  }
}

TEST(V4l2Source, WhatCannotBeUsedIsNamedWithItsMend) {
  Rig rig;
  rig.kernel.open_error = EACCES;
  rig.expect_refused(ErrorKind::device, "60-pliant.rules", {"/dev/video2", ""});
  rig.expect_refused(ErrorKind::device, "60-pliant.rules");  // also where it is searched for
  rig.kernel.open_error = EBUSY;
  rig.expect_refused(ErrorKind::device, "another program uses it", {"/dev/video2", ""});
  rig.kernel.open_error = 0;
  rig.kernel.width = 128;
  rig.expect_refused(ErrorKind::device, "gives 128x48 Z16 instead of 64x48 Z16");
  rig.kernel.width = 64;
  rig.kernel.buffers_given = 1;
  rig.expect_refused(ErrorKind::device, "1 buffers");
  const auto blind = open_v4l2({}, {}, rig.kernel);
  ASSERT_FALSE(blind);
  EXPECT_EQ(blind.error().kind, ErrorKind::bad_input);
  EXPECT_NE(blind.error().message.find("--sensor"), std::string::npos);
}

TEST(V4l2Source, ShortAndDamagedFramesAreBadAndGapsAreCounted) {
  Rig rig;
  rig.start();
  rig.next();
  ASSERT_EQ(rig.item.event, SourceEvent::frame);
  rig.kernel.used = 100;
  rig.next();
  EXPECT_EQ(rig.item.event, SourceEvent::bad_frame);
  EXPECT_NE(rig.item.fault.find("100 bytes of 6144"), std::string::npos) << rig.item.fault;
  rig.kernel.used = 0;
  rig.kernel.flags |= V4L2_BUF_FLAG_ERROR;
  rig.next();
  EXPECT_EQ(rig.item.event, SourceEvent::bad_frame);
  EXPECT_NE(rig.item.fault.find("damaged"), std::string::npos);
  rig.kernel.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  rig.kernel.sequence_step = 4;
  rig.next();
  EXPECT_EQ(rig.item.frame.number, 3);
  rig.next();
  EXPECT_EQ(rig.item.frame.number, 7);
  rig.kernel.flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  rig.next();
  EXPECT_EQ(rig.item.event, SourceEvent::frame);
  EXPECT_EQ(rig.item.frame.utime, rig.kernel.wall_us()) << "without a stamp, the arrival counts";
}

TEST(V4l2Source, SilenceIsATimeoutUnpluggingALossALieAnError) {
  {
    Rig rig;
    rig.start();
    rig.kernel.silent = true;
    const std::int64_t before = rig.kernel.now_us;
    rig.next(70);
    EXPECT_EQ(rig.item.event, SourceEvent::timeout);
    EXPECT_EQ(rig.kernel.now_us - before, 70'000);
    rig.kernel.plugged = false;
    rig.next(70);
    EXPECT_EQ(rig.item.event, SourceEvent::lost);
    EXPECT_NE(rig.item.fault.find("No such device"), std::string::npos) << rig.item.fault;
    rig.source.reset();
    EXPECT_EQ(rig.kernel.maps, 0);
  }
  Rig rig;
  rig.start();
  rig.kernel.index_offset = 40;
  rig.next();
  EXPECT_EQ(rig.item.event, SourceEvent::lost);
}

TEST(V4l2Source, TwoHundredPullsLeakNothing) {
  Rig rig;
  const auto cycle = [&rig] {
    rig.kernel.plugged = true;
    rig.start();
    ASSERT_NE(rig.source, nullptr);
    rig.next();
    ASSERT_EQ(rig.item.event, SourceEvent::frame) << rig.item.fault;
    rig.kernel.plugged = false;
    rig.next();
    ASSERT_EQ(rig.item.event, SourceEvent::lost);
    rig.source.reset();
    rig.expect_refused(ErrorKind::absent, "no video device offers depth");
    ASSERT_EQ(rig.kernel.open_files, 0);
    ASSERT_EQ(rig.kernel.maps, 0);
  };
  for (int i = 0; i < 20; ++i) cycle();
  const std::size_t heap = mallinfo2().uordblks;
  for (int i = 0; i < 180 && !testing::Test::HasFatalFailure(); ++i) cycle();
  EXPECT_EQ(mallinfo2().uordblks, heap);
}

TEST(V4l2Source, AnInputOutputErrorIsABadFrameManyAreALoss) {
  Rig rig;
  rig.start();
  rig.next();
  rig.kernel.fail_at = rig.kernel.calls + 3;  // give back, poll, then the frame
  rig.kernel.fail_with = EIO;
  rig.next();
  EXPECT_EQ(rig.item.event, SourceEvent::bad_frame);
  rig.next();
  EXPECT_EQ(rig.item.event, SourceEvent::frame) << rig.item.fault;
}

struct Ending {
  int frames = 0, bad = 0;
  std::string error;
};

Ending six_frames(FakeKernel& kernel) {
  Ending ending;
  auto source = open_v4l2({}, wish(), kernel);
  if (!source) return {0, 0, source.error().message};
  SourceItem item;
  for (int i = 0; i < 40 && ending.frames < 6; ++i) {
    (*source)->next(20, item);
    if (item.event == SourceEvent::frame) {
      ++ending.frames;
      EXPECT_EQ(item.frame.depth[64 * 48 - 1], 0x0303);
    }
    if (item.event == SourceEvent::bad_frame) ++ending.bad;
    if (item.event == SourceEvent::lost) {
      ending.error = item.fault;
      break;
    }
  }
  return ending;
}

class FailureSweep : public testing::TestWithParam<std::tuple<int, bool, bool>> {};

TEST_P(FailureSweep, OfEveryCallEndsInFramesOrAnErrorWithAllGivenBack) {
  const auto [error, from_then_on, multi_planar] = GetParam();
  int errors = 0, n = 1;
  for (;; ++n) {
    FakeKernel kernel;
    kernel.picture.resize(64 * 48 * 2, std::byte{3});
    kernel.multi_planar = multi_planar;
    kernel.fail_at = n;
    kernel.fail_with = error;
    kernel.fail_on = from_then_on;
    const Ending ending = six_frames(kernel);
    // A silent device is no error of the driver's: who watches it notices.
    const bool silent = from_then_on && (error == EAGAIN || error == EINTR);
    EXPECT_TRUE(ending.frames == 6 || !ending.error.empty() || silent || ending.bad > 0) << "call " << n;
    EXPECT_EQ(kernel.open_files, 0) << "call " << n;
    EXPECT_EQ(kernel.maps, 0) << "call " << n;
    errors += ending.error.empty() ? 0 : 1;
    if (kernel.calls < n) break;  // all calls had their turn
    ASSERT_LT(n, 500);
  }
  EXPECT_GE(n, 30);
  EXPECT_GE(errors, error == EINTR ? 0 : 3);
}
INSTANTIATE_TEST_SUITE_P(V4l2, FailureSweep,
                         testing::Combine(testing::Values(EIO, ENODEV, EAGAIN, EINVAL, EBUSY, EINTR, ENOMEM,
                                                          EACCES),
                                          testing::Bool(), testing::Bool()));

TEST(V4l2Listing, TellsNodesFaultsAndWhoIsBusy) {
  for (const bool multi_planar : {false, true}) {
    FakeKernel kernel;
    kernel.multi_planar = multi_planar;
    V4l2Listing listing = list_v4l2(kernel);
    ASSERT_EQ(listing.nodes.size(), 1U);
    EXPECT_EQ(listing.nodes.front().path, "/dev/video2");
    EXPECT_EQ(listing.nodes.front().formats, kernel.formats);
    EXPECT_FALSE(listing.nodes.front().busy);
    ASSERT_EQ(listing.faults.size(), 1U) << "/dev/video0 is not there any more";
    kernel.used_elsewhere = true;
    listing = list_v4l2(kernel);
    ASSERT_EQ(listing.nodes.size(), 1U);
    EXPECT_TRUE(listing.nodes.front().busy);
    EXPECT_EQ(kernel.open_files, 0);
    kernel.used_elsewhere = false;
    kernel.is_capture = false;
    EXPECT_TRUE(list_v4l2(kernel).nodes.empty());
  }
}

TEST(V4l2Listing, OpensNothingThatIsNoVideoDevice) {
  for (const char* path : {"/dev/null", "/dev/zero", "/dev/tty", "/", "/etc/passwd"}) {
    const auto source = open_v4l2({path, ""}, wish());
    ASSERT_FALSE(source) << path;
    EXPECT_EQ(source.error().kind, ErrorKind::bad_input) << path;
    EXPECT_NE(source.error().message.find("is no video device"), std::string::npos) << source.error().message;
  }
}

TEST(V4l2Address, IsAPathABusOrNothingAndAFormat) {
  EXPECT_EQ(parse_v4l2_address("/dev/video0?format=Y16")->format, "Y16");
  EXPECT_EQ(parse_v4l2_address("/dev/video0?format=Y16")->place, "/dev/video0");
  EXPECT_EQ(parse_v4l2_address("usb-0000:00:14.0-2")->place, "usb-0000:00:14.0-2");
  EXPECT_EQ(parse_v4l2_address("")->place, "");
  for (const char* wrong : {"?format=YUYV", "/dev/video0?size=3", "?", "?format="}) {
    const auto parsed = parse_v4l2_address(wrong);
    ASSERT_FALSE(parsed) << wrong;
    EXPECT_EQ(parsed.error().kind, ErrorKind::bad_input);
  }
}

}  // namespace
}  // namespace pliant::test

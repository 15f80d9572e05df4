// Frames that another program writes into a node of v4l2loopback.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <thread>

#include "firmware-app/measure/clock.hpp"
#include "tests/vm/forth_and_back.hpp"
#include "tests/vm/guest.hpp"

namespace pliant::test {
namespace {

constexpr const char* kNode = "/dev/video7";  // as init.sh loads the module
constexpr int kRate = 10;

/// Writes the recorded pictures, forth and back, as Y16.
class Writer {
 public:
  Writer() : file_(open(kNode, O_RDWR | O_CLOEXEC)) {
    const Intrinsics& camera = recorded().camera;
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = static_cast<std::uint32_t>(camera.width);
    format.fmt.pix.height = static_cast<std::uint32_t>(camera.height);
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_Y16;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.bytesperline = format.fmt.pix.width * 2;
    format.fmt.pix.sizeimage = format.fmt.pix.bytesperline * format.fmt.pix.height;
    EXPECT_EQ(ioctl(file_, VIDIOC_S_FMT, &format), 0)
        << std::strerror(errno);  // NOLINT(concurrency-mt-unsafe)
    thread_ = std::thread([this] { write_all(); });
  }
  ~Writer() {
    stop_ = true;
    thread_.join();
    close(file_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

 private:
  void write_all() {
    const Pictures& pictures = recorded().pictures;
    std::int64_t due = monotonic_ns();
    for (std::size_t i = 0; !stop_; ++i) {
      const auto& picture = pictures[forth_and_back(i, pictures.size())];
      const auto bytes = static_cast<ssize_t>(2 * picture.size());
      if (write(file_, picture.data(), 2 * picture.size()) != bytes) usleep(1000);
      due = std::max(due + 1'000'000'000 / kRate, monotonic_ns() - 1'000'000'000 / kRate);
      sleep_until_ns(due);
    }
  }
  int file_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

class Loopback : public CommandTest {};

TEST_F(Loopback, WhatAnotherProgramWritesIsTracked) {
  if (!std::filesystem::exists(kNode)) GTEST_SKIP() << "v4l2loopback is not loaded in this guest";
  Writer writer;
  Tracking tracking(folder_, std::string("v4l2:") + kNode + "?format=Y16", kRate);
  ASSERT_TRUE(tracking.until(60, [](const StatusMessage& status) {
    return status.state == TrackState::tracking;
  })) << tracking.told();
  const double rate = tracking.rate_within(60);
  printf("[          ] %.1f frames a second tracked\n", rate);
  EXPECT_GE(rate, kLeastRate) << tracking.told();
  EXPECT_EQ(tracking.latest().bad_frames, 0) << tracking.told();
  EXPECT_EQ(tracking.stop().code, 0);
}

}  // namespace
}  // namespace pliant::test

// What devices and the network hand over: recordings' layouts, a kernel that says anything, LCM logs and
// messages.
#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <list>
#include <vector>

#include "drivers/lcm/depth_assembler.hpp"
#include "drivers/lcm/depth_log.hpp"
#include "drivers/openni2/oni_layout.hpp"
#include "drivers/v4l2/v4l2.hpp"
#include "tests/fuzz/promises.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace pliant {

namespace {

/// A kernel whose every answer comes out of the input: one byte says whether the call fails (0), leaves the
/// argument as it is (1), or fills it with what follows (any other).
class FuzzKernel final : public V4l2System {
 public:
  explicit FuzzKernel(Bytes data) : data_(data) {}
  std::vector<std::string> nodes() override { return {"/dev/video0"}; }
  int open(const char* /*path*/) override { return 3; }
  int close(int /*file*/) override { return 0; }
  int ioctl(int /*file*/, unsigned long request, void* argument) override {
    const unsigned answer = byte();
    if (answer == 0) return fail();
    if (answer == 1) return 0;
    if (request != VIDIOC_QBUF && request != VIDIOC_DQBUF && request != VIDIOC_QUERYBUF) {
      fill(argument, _IOC_SIZE(request));
      return 0;
    }
    // A kernel writes where the pointer for the planes leads, not over it.
    auto& buffer = *static_cast<v4l2_buffer*>(argument);
    const v4l2_buffer before = buffer;
    fill(&buffer, sizeof buffer);
    if (before.type == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE) {
      buffer.m.planes = before.m.planes;
      fill(buffer.m.planes, sizeof(v4l2_plane));
    }
    return 0;
  }
  void* map(std::size_t length, int /*file*/, std::int64_t /*offset*/) override {
    if (length > std::size_t{1} << 22) {
      errno = ENOMEM;
      return nullptr;
    }
    // Of the very length, so that reading behind it is seen.
    return memory_.emplace_back(length).data();
  }
  int unmap(void* /*memory*/, std::size_t /*length*/) override { return 0; }
  int poll(int /*file*/, int /*timeout_ms*/, short& events) override {
    const unsigned answer = byte();
    events = static_cast<short>(answer & (POLLIN | POLLERR | POLLHUP));
    if (answer == 0) return fail();
    return answer == 1 ? 0 : 1;
  }
  std::int64_t monotonic_us() override { return 1'000'000'000; }
  std::int64_t wall_us() override { return 1'700'000'000'000'000; }

 private:
  unsigned byte() {
    if (at_ >= data_.size()) return 0;
    return std::to_integer<unsigned>(data_[at_++]);
  }
  int fail() {
    constexpr int kErrors[] = {EINVAL, ENOTTY, EIO, ENODEV, EAGAIN, EBUSY, EINTR, ENOMEM};
    errno = kErrors[byte() % 8];
    return -1;
  }
  void fill(void* argument, std::size_t bytes) {
    bytes = std::min(bytes, data_.size() - at_);
    if (bytes > 0) std::memcpy(argument, data_.data() + at_, bytes);
    at_ += bytes;
  }
  Bytes data_;
  std::size_t at_ = 0;
  std::list<std::vector<std::byte>> memory_;
};

/// Every reading can be read.
void read_frame(const DepthFrame& frame) {
  volatile std::uint16_t sink = 0;
  for (int v = 0; v < frame.height; ++v)
    for (int u = 0; u < frame.width; ++u) sink = frame.depth[std::ptrdiff_t{v} * frame.stride + u];
  static_cast<void>(sink);
}

}  // namespace

void fuzz_oni(Bytes data) {
  const ScratchFile scratch(data);
  if (const Outcome sound = check_oni_layout(scratch.get(), data.size(), "file"); !sound)
    check_error(sound.error());
}

void fuzz_v4l2(Bytes data) {
  FuzzKernel kernel(data);
  SourceWish wish;
  wish.camera = Intrinsics{32, 24, 30, 30, 15.5, 11.5, 1000};
  const auto source = open_v4l2({}, wish, kernel);
  if (!source) {
    check_line(source.error().message);
    return;
  }
  SourceItem item;
  for (int i = 0; i < 16; ++i) {
    (*source)->next(1, item);
    if (item.event == SourceEvent::frame) {
      promise(item.frame.width == 32 && item.frame.height == 24, "frames have the size that was asked for");
      read_frame(item.frame);
    } else if (item.event != SourceEvent::timeout) {
      check_line(item.fault);
    }
    if (item.event == SourceEvent::lost) return;
  }
}

void fuzz_lcm_log(Bytes data) {
  const ScratchFile scratch(data);
  const auto source = open_depth_log(scratch.path());
  if (!source) {
    promise(source.error().kind == ErrorKind::bad_input, "a log's error is a bad input");
    check_line(source.error().message);
    return;
  }
  promise(intrinsics_fault((*source)->intrinsics()) == nullptr, "an accepted camera is sound");
  SourceItem item;
  std::int64_t number = 0;
  do {
    (*source)->next(0, item);
    promise(item.event != SourceEvent::timeout && item.event != SourceEvent::lost,
            "a log brings frames or ends");
    if (item.event == SourceEvent::end) break;
    promise(item.frame.number == number++, "frames are counted");
    if (item.event == SourceEvent::frame) read_frame(item.frame);
  } while (true);
}

void fuzz_message(Bytes data) {
  const std::span body(static_cast<const std::uint8_t*>(static_cast<const void*>(data.data())), data.size());
  PoseMessage pose;
  RegionsMessage regions;
  DeformedMessage deformed;
  StatusMessage status;
  DepthMessage depth;
  if (decode(body, pose)) promise(std::isfinite(pose.trans[0]), "numbers are finite");
  if (decode(body, regions)) {
    promise(regions.part < regions.parts, "parts are in range");
    for (const RegionMessage& region : regions.regions)
      promise(!region.joint || std::isfinite(region.joint->x), "a joint is somewhere or none");
  }
  if (decode(body, deformed)) {
    promise(deformed.index.size() == deformed.position.size(), "arrays match");
    promise(deformed.index.size() == deformed.strain.size(), "arrays match");
  }
  if (decode(body, status))
    promise(status.rate >= 0 && status.strain_energy >= 0, "measures are no less than none");
  if (!decode(body, depth)) return;
  promise(intrinsics_fault(depth.camera) == nullptr, "an accepted camera is sound");
  DepthAssembler assembler(depth.camera);
  promise(assembler.fits(depth), "a message fits its own camera");
  if (assembler.take(depth)) read_frame(assembler.frame());
}

}  // namespace pliant

#include "tests/v4l2/fake_kernel.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>

namespace pliant::test {

namespace {

constexpr int kFile = 7, kOtherFile = 8;

int error(int number) {
  errno = number;
  return -1;
}

}  // namespace

bool FakeKernel::fails() {
  ++calls;
  return calls == fail_at || (fail_on && fail_at != 0 && calls > fail_at);
}

std::uint32_t FakeKernel::row_bytes() const {
  if (code_ == v4l2_fourcc('Y', '1', '2', 'P')) return width * 3 / 2 + padding;
  if (code_ == V4L2_PIX_FMT_Y10BPACK) return width * 5 / 4 + padding;
  return 2 * width + padding;
}

std::uint32_t FakeKernel::image_bytes() const {
  return row_bytes() * height * (code_ == V4L2_PIX_FMT_INZI ? 2 : 1);
}

int FakeKernel::open(const char* name) {
  if (fails()) return error(fail_with);
  const bool other = std::string_view(name) == "/dev/video0" && !other_formats.empty();
  if ((name != path && !other) || !plugged) return error(ENOENT);
  if (open_error != 0) return error(open_error);
  ++open_files;
  return other ? kOtherFile : kFile;
}

int FakeKernel::close(int /*file*/) {
  --open_files;
  streaming_ = false;
  queue_.clear();
  return 0;
}

int FakeKernel::ioctl(int file, unsigned long request, void* argument) {
  if (fails()) return error(fail_with);
  if ((file != kFile && file != kOtherFile) || open_files != 1) return error(EBADF);
  if (!plugged) return error(ENODEV);
  if (file == kOtherFile && request == VIDIOC_ENUM_FMT) {
    auto& description = *static_cast<v4l2_fmtdesc*>(argument);
    if (description.index >= other_formats.size()) return error(EINVAL);
    description.pixelformat = other_formats[description.index];
    return 0;
  }
  return answer(request, argument);
}

int FakeKernel::answer(unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& capability = *static_cast<v4l2_capability*>(argument);
      std::strcpy(static_cast<char*>(static_cast<void*>(capability.card)), "Fake depth");
      std::copy(bus.begin(), bus.end(), static_cast<char*>(static_cast<void*>(capability.bus_info)));
      const std::uint32_t kind = !is_capture    ? std::uint32_t{V4L2_CAP_VIDEO_OUTPUT}
                                 : multi_planar ? std::uint32_t{V4L2_CAP_VIDEO_CAPTURE_MPLANE}
                                                : std::uint32_t{V4L2_CAP_VIDEO_CAPTURE};
      capability.device_caps = kind | V4L2_CAP_STREAMING;
      capability.capabilities = capability.device_caps | V4L2_CAP_DEVICE_CAPS;
      return 0;
    }
    case VIDIOC_ENUM_FMT: {
      auto& description = *static_cast<v4l2_fmtdesc*>(argument);
      if (description.index >= formats.size()) return error(EINVAL);
      description.pixelformat = formats[description.index];
      return 0;
    }
    case VIDIOC_S_FMT:
      return streaming_ ? error(EBUSY) : set_format(*static_cast<v4l2_format*>(argument));
    case VIDIOC_S_PARM:
      static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {1, 15};
      return 0;
    case VIDIOC_REQBUFS: {
      auto& wanted = *static_cast<v4l2_requestbuffers*>(argument);
      if (used_elsewhere) return error(EBUSY);
      if (wanted.count > 0 && streaming_) return error(EBUSY);
      if (maps > 0) return error(EBUSY);  // as old kernels: buffers that are mapped cannot be freed
      if (wanted.count > 0) wanted.count = buffers_given;
      memory_.assign(wanted.count, std::vector<std::byte>(image_bytes()));
      queue_.clear();
      return 0;
    }
    case VIDIOC_QUERYBUF: {
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      if (buffer.index >= memory_.size()) return error(EINVAL);
      if (multi_planar) {
        buffer.m.planes[0].length = image_bytes();
        buffer.m.planes[0].m.mem_offset = buffer.index * 65536;
      } else {
        buffer.length = image_bytes();
        buffer.m.offset = buffer.index * 65536;
      }
      return 0;
    }
    case VIDIOC_QBUF: {
      const auto& buffer = *static_cast<const v4l2_buffer*>(argument);
      if (buffer.index >= memory_.size() ||
          std::find(queue_.begin(), queue_.end(), buffer.index) != queue_.end())
        return error(EINVAL);
      if (multi_planar && buffer.length != 1) return error(EINVAL);
      queue_.push_back(buffer.index);
      return 0;
    }
    case VIDIOC_DQBUF:
      return dequeue(*static_cast<v4l2_buffer*>(argument));
    case VIDIOC_STREAMON:
      streaming_ = true;
      due_us_ = now_us + frame_us;
      return 0;
    case VIDIOC_STREAMOFF:
      streaming_ = false;
      queue_.clear();
      return 0;
    default:
      return error(ENOTTY);
  }
}

int FakeKernel::set_format(v4l2_format& format) {
  const std::uint32_t wanted = multi_planar ? format.fmt.pix_mp.pixelformat : format.fmt.pix.pixelformat;
  code_ = std::find(formats.begin(), formats.end(), wanted) != formats.end() ? wanted : formats.front();
  if (multi_planar) {
    v4l2_pix_format_mplane& p = format.fmt.pix_mp;
    p.width = width;
    p.height = height;
    p.pixelformat = code_;
    p.num_planes = 1;
    p.plane_fmt[0].bytesperline = row_bytes();
    p.plane_fmt[0].sizeimage = image_bytes();
  } else {
    v4l2_pix_format& p = format.fmt.pix;
    p.width = width;
    p.height = height;
    p.pixelformat = code_;
    p.bytesperline = row_bytes();
    p.sizeimage = image_bytes();
  }
  return 0;
}

int FakeKernel::dequeue(v4l2_buffer& buffer) {
  if (!streaming_) return error(EINVAL);
  if (silent || queue_.empty() || now_us < due_us_) return error(EAGAIN);
  const std::uint32_t index = queue_.front();
  queue_.erase(queue_.begin());
  std::vector<std::byte>& memory = memory_[index];
  std::copy_n(picture.begin(), std::min(picture.size(), memory.size()), memory.begin());
  buffer.index = index + index_offset;
  buffer.flags = flags;
  buffer.sequence = sequence_;
  sequence_ += sequence_step;
  const std::int64_t stamp_us = due_us_ - 500 + stamp_offset_us;
  buffer.timestamp.tv_sec = stamp_us / 1'000'000;
  buffer.timestamp.tv_usec = stamp_us % 1'000'000;
  const std::uint32_t filled = used != 0 ? used : image_bytes();
  (multi_planar ? buffer.m.planes[0].bytesused : buffer.bytesused) = filled;
  due_us_ += frame_us;
  return 0;
}

void* FakeKernel::map(std::size_t /*length*/, int /*file*/, std::int64_t offset) {
  if (fails()) {
    errno = fail_with;
    return nullptr;
  }
  ++maps;
  return memory_[static_cast<std::size_t>(offset / 65536)].data();
}

int FakeKernel::unmap(void* /*memory*/, std::size_t /*length*/) {
  --maps;
  return 0;
}

int FakeKernel::poll(int /*file*/, int timeout_ms, short& events) {
  if (fails()) return error(fail_with);
  events = POLLIN;
  if (!plugged) {
    events = POLLERR | POLLHUP;
    return 1;
  }
  if (!silent && streaming_ && !queue_.empty() && due_us_ <= now_us + timeout_ms * 1000) {
    now_us = std::max(now_us, due_us_);
    return 1;
  }
  now_us += timeout_ms * 1000;
  events = 0;
  return 0;
}

}  // namespace pliant::test

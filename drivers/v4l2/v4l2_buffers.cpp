#include "drivers/v4l2/v4l2_buffers.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <array>
#include <cerrno>

namespace pliant {

namespace {

/// A v4l2_buffer with room for its planes.
struct Buffer {
  v4l2_buffer buffer{};
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
  Buffer(std::uint32_t type, std::uint32_t index, bool multi_planar) {
    buffer.type = type;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = index;
    if (multi_planar) {
      buffer.m.planes = planes.data();
      buffer.length = VIDEO_MAX_PLANES;
    }
  }
};

}  // namespace

std::uint32_t V4l2Buffers::type() const {
  return multi_planar_ ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

Outcome V4l2Buffers::start(const std::string& path, std::size_t least_bytes) {
  v4l2_requestbuffers request{};
  request.count = kCount;
  request.type = type();
  request.memory = V4L2_MEMORY_MMAP;
  if (const int error = file_.call(VIDIOC_REQBUFS, &request); error != 0)
    return v4l2_error(path, "gives no buffers", error);
  requested_ = true;
  if (request.count < 2)
    return Error{ErrorKind::device,
                 fmt::format("v4l2: {}: gives {} buffers, 2 are needed", path, request.count)};
  buffers_.reserve(kCount);
  for (std::uint32_t i = 0; i < request.count && i < kCount; ++i) {
    Buffer asked(type(), i, multi_planar_);
    if (const int error = file_.call(VIDIOC_QUERYBUF, &asked.buffer); error != 0)
      return v4l2_error(path, "does not tell its buffers", error);
    const std::size_t length = multi_planar_ ? asked.planes[0].length : asked.buffer.length;
    const std::int64_t offset = multi_planar_ ? asked.planes[0].m.mem_offset : asked.buffer.m.offset;
    if (length < least_bytes)
      return Error{ErrorKind::device,
                   fmt::format("v4l2: {}: a buffer of {} bytes is too small for a frame of {}", path, length,
                               least_bytes)};
    void* memory = system_.map(length, file_.get(), offset);
    if (memory == nullptr) return v4l2_error(path, "a buffer cannot be mapped", errno);
    buffers_.push_back({memory, length});
    if (const int error = give_back(i); error != 0) return v4l2_error(path, "takes no buffer", error);
  }
  auto stream = static_cast<int>(type());
  if (const int error = file_.call(VIDIOC_STREAMON, &stream); error != 0)
    return v4l2_error(path, "does not start to stream", error);
  streaming_ = true;
  return success();
}

void V4l2Buffers::stop() {
  auto stream = static_cast<int>(type());
  if (streaming_) static_cast<void>(file_.call(VIDIOC_STREAMOFF, &stream));
  for (const Mapped& buffer : buffers_) system_.unmap(buffer.memory, buffer.length);
  buffers_.clear();
  if (requested_) {
    v4l2_requestbuffers none{};
    none.type = type();
    none.memory = V4L2_MEMORY_MMAP;
    static_cast<void>(file_.call(VIDIOC_REQBUFS, &none));
  }
  streaming_ = requested_ = false;
}

int V4l2Buffers::take(V4l2Filled& filled) {
  Buffer taken(type(), 0, multi_planar_);
  if (const int error = file_.call(VIDIOC_DQBUF, &taken.buffer); error != 0) return error;
  const v4l2_buffer& buffer = taken.buffer;
  if (buffer.index >= buffers_.size()) return EPROTO;
  const Mapped& mapped = buffers_[buffer.index];
  const v4l2_plane& plane = taken.planes[0];
  std::size_t used = multi_planar_ ? plane.bytesused : buffer.bytesused;
  const std::size_t begin = multi_planar_ ? plane.data_offset : 0;
  if (used > mapped.length) used = mapped.length;
  const auto* bytes = static_cast<const std::byte*>(mapped.memory);
  filled.index = buffer.index;
  filled.bytes = begin < used ? std::span(bytes + begin, used - begin) : std::span<const std::byte>();
  filled.faulty = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0;
  filled.sequence = buffer.sequence;
  const bool monotonic = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  filled.stamp_us =
      monotonic ? std::int64_t{buffer.timestamp.tv_sec} * 1'000'000 + std::int64_t{buffer.timestamp.tv_usec}
                : 0;
  return 0;
}

int V4l2Buffers::give_back(std::uint32_t index) {
  Buffer given(type(), index, multi_planar_);
  // One plane is what depth formats have; drivers refuse more.
  if (multi_planar_) given.buffer.length = 1;
  return file_.call(VIDIOC_QBUF, &given.buffer);
}

}  // namespace pliant

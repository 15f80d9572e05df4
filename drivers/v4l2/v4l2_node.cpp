#include "drivers/v4l2/v4l2_node.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "drivers/common/printable.hpp"
#include "drivers/v4l2/v4l2_format.hpp"

namespace pliant {

namespace {

constexpr std::uint32_t kMostFormats = 64;

/// A driver's text, which need not end with a zero.
template <std::size_t N>
std::string text_of(const __u8 (&text)[N]) {
  std::string out;
  for (std::size_t i = 0; i < N && text[i] != 0; ++i) out += static_cast<char>(text[i]);
  return printable(out, N);
}

}  // namespace

V4l2File& V4l2File::operator=(V4l2File&& other) noexcept {
  if (this != &other) {
    close();
    system_ = other.system_;
    file_ = other.file_;
    other.file_ = -1;
  }
  return *this;
}

void V4l2File::close() {
  if (file_ >= 0) system_->close(file_);
  file_ = -1;
}

int V4l2File::call(unsigned long request, void* argument) const {
  for (int attempt = 0; attempt < 100; ++attempt) {
    if (system_->ioctl(file_, request, argument) == 0) return 0;
    if (errno != EINTR) return errno;
  }
  return EINTR;
}

bool V4l2Node::offers_depth() const {
  return capture && std::any_of(formats.begin(), formats.end(),
                                [](std::uint32_t code) { return find_v4l2_format(code) != nullptr; });
}

Error v4l2_error(const std::string& path, std::string_view what, int error) {
  const bool absent = error == ENOENT || error == ENODEV || error == ENXIO;
  std::string mend;
  if (error == EACCES || error == EPERM)
    mend = "; install the udev rules (60-pliant.rules) or add yourself to the group video";
  if (error == EBUSY) mend = "; another program uses it ('fuser " + path + "' tells which)";
  return {absent ? ErrorKind::absent : ErrorKind::device,
          fmt::format("v4l2: {}: {}: {}{}", path, what, std::strerror(error),
                      mend)};  // NOLINT(concurrency-mt-unsafe)
}

Outcome open_v4l2_node(V4l2System& system, const std::string& path, V4l2File& file, V4l2Node& node) {
  const auto no_video_device = [&path] {
    return Error{ErrorKind::bad_input, fmt::format("v4l2: {} is no video device", path)};
  };
  const int opened = system.open(path.c_str());
  if (opened < 0) return errno == ENOTTY ? no_video_device() : v4l2_error(path, "cannot be opened", errno);
  file = V4l2File(system, opened);
  node = {};
  node.path = path;
  v4l2_capability capability{};
  if (const int error = file.call(VIDIOC_QUERYCAP, &capability); error != 0) {
    if (error == ENOTTY || error == EINVAL) return no_video_device();
    return v4l2_error(path, "cannot be asked what it is", error);
  }
  node.card = text_of(capability.card);
  node.bus = text_of(capability.bus_info);
  const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps
                                                                                  : capability.capabilities;
  node.multi_planar = (can & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0 && (can & V4L2_CAP_VIDEO_CAPTURE) == 0;
  node.capture = (can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0 &&
                 (can & V4L2_CAP_STREAMING) != 0;
  if (!node.capture) return success();
  for (std::uint32_t i = 0; i < kMostFormats; ++i) {
    v4l2_fmtdesc description{};
    description.index = i;
    description.type = node.multi_planar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
    const int error = file.call(VIDIOC_ENUM_FMT, &description);
    if (error == EINVAL || error == ENOTTY) break;  // there are no more, or none
    if (error != 0) return v4l2_error(path, "its formats cannot be listed", error);
    node.formats.push_back(description.pixelformat);
  }
  return success();
}

}  // namespace pliant

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "drivers/v4l2/v4l2.hpp"
#include "drivers/v4l2/v4l2_buffers.hpp"
#include "drivers/v4l2/v4l2_format.hpp"

namespace pliant {

namespace {

constexpr int kMostFaultsInARow = 10;                // I/O errors after which a device counts as gone
constexpr std::int64_t kOldestStampUs = 10'000'000;  // of a frame that was fetched in time

class V4l2Source final : public DepthSource {
 public:
  V4l2Source(V4l2System& system, V4l2File file, V4l2Node node, const SourceWish& wish)
      : system_(system),
        file_(std::move(file)),
        node_(std::move(node)),
        buffers_(system_, file_, node_.multi_planar),
        camera_(*wish.camera),
        sensor_(wish.sensor),
        rate_(wish.rate) {}

  [[nodiscard]] Outcome start(const V4l2Format& format) {
    if (Outcome done = set_format(format); !done) return done;
    ask_for_rate();
    unpacked_.resize(std::size_t{layout_.width} * layout_.height);
    return buffers_.start(node_.path, layout_.bytes);
  }
  [[nodiscard]] const Intrinsics& intrinsics() const override { return camera_; }
  [[nodiscard]] const SensorDescription& sensor() const override { return sensor_; }
  [[nodiscard]] bool live() const override { return true; }
  [[nodiscard]] double rate() const override { return rate_; }
  [[nodiscard]] std::string place() const override { return node_.bus; }
  void close() override {
    buffers_.stop();
    file_.close();
  }
  void next(int timeout_ms, SourceItem& item) override;

 private:
  [[nodiscard]] Outcome set_format(const V4l2Format& format);
  void ask_for_rate();
  void describe(const V4l2Filled& filled, SourceItem& item);
  [[nodiscard]] std::int64_t capture_time(std::int64_t stamp_us);
  void lose(SourceItem& item, std::string_view what, int error) const {
    item.event = SourceEvent::lost;
    item.fault = v4l2_error(node_.path, what, error).message;
  }

  V4l2System& system_;
  V4l2File file_;
  V4l2Node node_;
  V4l2Buffers buffers_;
  Intrinsics camera_;
  SensorDescription sensor_;
  double rate_;
  V4l2Layout layout_;
  std::vector<std::uint16_t> unpacked_;
  std::int64_t held_ = -1;  // the buffer that is lent out
  std::int64_t number_ = -1;
  std::uint32_t sequence_ = 0;
  bool our_clock_ = false;  // a stamp has shown that the driver's clock is the monotonic one
  int faults_in_a_row_ = 0;
};

Outcome V4l2Source::set_format(const V4l2Format& format) {
  v4l2_format wanted{};
  const auto width = static_cast<std::uint32_t>(camera_.width),
             height = static_cast<std::uint32_t>(camera_.height);
  if (node_.multi_planar) {
    wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE;
    wanted.fmt.pix_mp.width = width;
    wanted.fmt.pix_mp.height = height;
    wanted.fmt.pix_mp.pixelformat = format.code;
    wanted.fmt.pix_mp.field = V4L2_FIELD_NONE;
    wanted.fmt.pix_mp.num_planes = 1;
  } else {
    wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    wanted.fmt.pix.width = width;
    wanted.fmt.pix.height = height;
    wanted.fmt.pix.pixelformat = format.code;
    wanted.fmt.pix.field = V4L2_FIELD_NONE;
  }
  if (const int error = file_.call(VIDIOC_S_FMT, &wanted); error != 0)
    return v4l2_error(node_.path, fmt::format("refuses {}x{} {}", width, height, format.name), error);
  // The driver sets what is nearest; only what it says now counts.
  const v4l2_pix_format_mplane& planes = wanted.fmt.pix_mp;
  const v4l2_pix_format& single = wanted.fmt.pix;
  if (node_.multi_planar && planes.num_planes != 1)
    return Error{ErrorKind::device,
                 fmt::format("v4l2: {}: {} planes; depth has one", node_.path, planes.num_planes)};
  const Result<V4l2Layout> layout =
      node_.multi_planar ? v4l2_layout(planes.pixelformat, planes.width, planes.height,
                                       planes.plane_fmt[0].bytesperline, planes.plane_fmt[0].sizeimage)
                         : v4l2_layout(single.pixelformat, single.width, single.height, single.bytesperline,
                                       single.sizeimage);
  if (!layout) return layout.error();
  layout_ = *layout;
  if (layout_.format->code != format.code || layout_.width != width || layout_.height != height)
    return Error{ErrorKind::device,
                 fmt::format("v4l2: {}: gives {}x{} {} instead of {}x{} {}", node_.path, layout_.width,
                             layout_.height, layout_.format->name, width, height, format.name)};
  return success();
}

void V4l2Source::ask_for_rate() {
  v4l2_streamparm parameters{};
  parameters.type = node_.multi_planar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(std::lround(rate_ * 1000))};
  // Not every driver knows rates; then the frames come as they come.
  if (file_.call(VIDIOC_S_PARM, &parameters) != 0) return;
  const v4l2_fract& period = parameters.parm.capture.timeperframe;
  if (period.numerator == 0 || period.denominator == 0) return;
  const double rate = static_cast<double>(period.denominator) / period.numerator;
  if (rate >= 1 && rate <= 1000) rate_ = rate;
}

void V4l2Source::next(int timeout_ms, SourceItem& item) {
  item.frame = {};
  item.fault.clear();
  item.event = SourceEvent::end;
  if (!file_.is_open()) return;
  if (held_ >= 0) {
    const int error = buffers_.give_back(static_cast<std::uint32_t>(held_));
    held_ = -1;
    if (error != 0) return lose(item, "takes a buffer no more", error);
  }
  item.event = SourceEvent::timeout;
  short events = 0;
  const int ready = system_.poll(file_.get(), std::max(timeout_ms, 0), events);
  if (ready < 0 && errno != EINTR) return lose(item, "cannot be waited for", errno);
  if (ready <= 0) return;
  V4l2Filled filled;
  const int error = buffers_.take(filled);
  if (error == EAGAIN) {
    // An error without a frame: unplugged, or the stream was stopped.
    if ((events & (POLLERR | POLLHUP | POLLNVAL)) != 0) lose(item, "the stream has ended", ENODEV);
    return;
  }
  if (error == EIO && ++faults_in_a_row_ < kMostFaultsInARow) {
    item.event = SourceEvent::bad_frame;
    item.fault = fmt::format("v4l2: {}: a frame was lost on its way", node_.path);
    item.frame.number = ++number_;
    return;
  }
  if (error != 0) return lose(item, "gives no frame", error);
  held_ = filled.index;
  describe(filled, item);
}

void V4l2Source::describe(const V4l2Filled& filled, SourceItem& item) {
  const std::uint32_t step = filled.sequence - sequence_;
  // Sequences begin anew, or stand still with some drivers; a step beyond a minute is no gap.
  number_ += number_ >= 0 && step > 1 && step < 2000 ? step : 1;
  sequence_ = filled.sequence;
  item.frame.number = number_;
  item.frame.utime = capture_time(filled.stamp_us);
  if (filled.faulty || filled.bytes.size() < layout_.bytes) {
    item.event = SourceEvent::bad_frame;
    item.fault = filled.faulty ? fmt::format("v4l2: {}: frame {} is marked as damaged", node_.path, number_)
                               : fmt::format("v4l2: {}: frame {} has {} bytes of {}", node_.path, number_,
                                             filled.bytes.size(), layout_.bytes);
    return;
  }
  faults_in_a_row_ = 0;
  item.event = SourceEvent::frame;
  item.frame.width = static_cast<int>(layout_.width);
  item.frame.height = static_cast<int>(layout_.height);
  if (const auto in_place = v4l2_readings_in_place(layout_, filled.bytes)) {
    item.frame.depth = *in_place;
    item.frame.stride = static_cast<int>(layout_.row_bytes / 2);
    return;
  }
  v4l2_unpack(layout_, filled.bytes, unpacked_);
  item.frame.depth = unpacked_.data();
  item.frame.stride = item.frame.width;
}

std::int64_t V4l2Source::capture_time(std::int64_t stamp_us) {
  // Both clocks at once, each time: the wall clock may have been set since the last frame.
  const std::int64_t monotonic = system_.monotonic_us(), wall = system_.wall_us();
  const bool possible = stamp_us > 0 && stamp_us <= monotonic;
  // Some drivers stamp by the camera's clock, whatever they say. Where one stamp was young, an old one is
  // that of a frame that lay in its buffer for so long: while this program was stopped, for example.
  our_clock_ = our_clock_ || (possible && monotonic - stamp_us < kOldestStampUs);
  return possible && our_clock_ ? stamp_us + (wall - monotonic) : wall;
}

Result<const V4l2Format*> choose_format(const V4l2Node& node, const std::string& name) {
  const auto offered = [&node](const V4l2Format& format) {
    return std::find(node.formats.begin(), node.formats.end(), format.code) != node.formats.end();
  };
  for (const V4l2Format& format : v4l2_formats())
    if (offered(format) && (name.empty() || format.name == name)) return &format;
  std::string there;
  for (const std::uint32_t code : node.formats) there += (there.empty() ? "" : ", ") + fourcc_text(code);
  return Error{ErrorKind::device, fmt::format("v4l2: {} ({}) offers no {}; it has {}", node.path, node.card,
                                              name.empty() ? std::string("depth format") : name,
                                              there.empty() ? "none" : there)};
}

/// Opens what the address names. A camera may have several nodes: the format asked for is that of one of
/// them.
Outcome find_node(V4l2System& system, const V4l2Address& address, V4l2File& file, V4l2Node& node) {
  if (address.place.starts_with('/')) return open_v4l2_node(system, address.place, file, node);
  Error reason{
      ErrorKind::absent,
      address.place.empty()
          ? std::string("v4l2: no video device offers depth; 'pliant devices' tells what is seen")
          : fmt::format("v4l2: no video device at '{}'; 'pliant devices' lists them", address.place)};
  for (const std::string& path : system.nodes()) {
    const Outcome opened = open_v4l2_node(system, path, file, node);
    if (!opened) {
      if (opened.error().kind == ErrorKind::device) reason = opened.error();
      continue;
    }
    if (node.offers_depth() && (address.place.empty() || node.bus == address.place)) {
      const Result<const V4l2Format*> format = choose_format(node, address.format);
      if (format) return success();
      reason = format.error();
    }
    file.close();
  }
  return reason;
}

}  // namespace

Result<V4l2Address> parse_v4l2_address(std::string_view text) {
  V4l2Address address;
  const std::size_t query = std::min(text.find('?'), text.size());
  address.place = text.substr(0, query);
  if (query == text.size()) return address;
  constexpr std::string_view kFormat = "format=";
  const std::string_view option = text.substr(query + 1);
  if (!option.starts_with(kFormat) || find_v4l2_format(option.substr(kFormat.size())) == nullptr)
    return Error{
        ErrorKind::bad_input,
        fmt::format("v4l2: '?{}' is not known; there are ?format=Z16, INZI, Y16, Y12P and Y10B", option)};
  address.format = option.substr(kFormat.size());
  return address;
}

Result<std::unique_ptr<DepthSource>> open_v4l2(const V4l2Address& address, const SourceWish& wish,
                                               V4l2System& system) {
  if (!wish.camera)
    return Error{
        ErrorKind::bad_input,
        "v4l2: a video device does not tell its camera; name a sensor description, for example --sensor "
        "config/sensors/realsense_d435.toml, or [sensor] description in the config"};
  V4l2File file;
  V4l2Node node;
  if (const Outcome found = find_node(system, address, file, node); !found) return found.error();
  if (!node.capture)
    return Error{ErrorKind::bad_input,
                 fmt::format("v4l2: {} ({}) delivers no pictures", node.path, node.card)};
  const Result<const V4l2Format*> format = choose_format(node, address.format);
  if (!format) return format.error();
  auto source = std::make_unique<V4l2Source>(system, std::move(file), std::move(node), wish);
  if (const Outcome started = source->start(**format); !started) return started.error();
  return std::unique_ptr<DepthSource>(std::move(source));
}

V4l2Listing list_v4l2(V4l2System& system) {
  V4l2Listing listing;
  for (const std::string& path : system.nodes()) {
    V4l2File file;
    V4l2Node node;
    if (const Outcome opened = open_v4l2_node(system, path, file, node); !opened) {
      listing.faults.push_back(opened.error());
    } else if (node.capture) {
      // Asking for no buffers changes nothing, and is refused while another file has some.
      v4l2_requestbuffers none{};
      none.type = node.multi_planar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
      none.memory = V4L2_MEMORY_MMAP;
      node.busy = file.call(VIDIOC_REQBUFS, &none) == EBUSY;
      listing.nodes.push_back(std::move(node));
    }
  }
  return listing;
}

}  // namespace pliant

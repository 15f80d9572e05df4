#include "tests/vm/uvc_camera.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "tests/vm/forth_and_back.hpp"

namespace pliant::test {

namespace {

// Numbers of the USB Device Class Definition for Video Devices 1.0, appendix A.
constexpr unsigned kInterface = 4, kEndpoint = 5, kAssociation = 11, kClassInterface = 0x24;
constexpr unsigned kVideo = 0x0e, kControlling = 1, kStreaming = 2, kCollection = 3;
constexpr unsigned kStreamEndpoint = 0x81, kBulk = 2, kPacket = 512;
constexpr std::uint8_t kSet = 0x01, kGetCurrent = 0x81, kGetLast = 0x87, kGetLength = 0x85, kGetInfo = 0x86;
constexpr std::uint32_t kPayload = 16384;   // bytes with the header of two
constexpr std::size_t kSettingsBytes = 26;  // of the probe and commit controls
// The GUID by which RealSense and the kernel name 16-bit depth (drivers/media/common/uvc.c).
constexpr std::array<std::uint8_t, 16> kDepthGuid = {'I',  'N',  'V',  'Z',  0x90, 0x2d, 0x58, 0x4a,
                                                     0x92, 0x0b, 0x77, 0x3f, 0x1f, 0x2c, 0x55, 0x6b};

void append(Bytes& to, const Bytes& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// A class-specific descriptor: its length and type before what it holds.
Bytes class_descriptor(const Bytes& content) {
  Bytes bytes;
  put8(bytes, static_cast<unsigned>(2 + content.size()));
  put8(bytes, kClassInterface);
  append(bytes, content);
  return bytes;
}

Bytes interface_descriptor(unsigned number, unsigned endpoints, unsigned subclass) {
  return {9,
          kInterface,
          static_cast<std::uint8_t>(number),
          0,
          static_cast<std::uint8_t>(endpoints),
          kVideo,
          static_cast<std::uint8_t>(subclass),
          0,
          0};
}

/// A camera terminal (unit 1) whose pictures go to the bus (unit 2); neither has controls.
Bytes control_units() {
  Bytes camera = {2, 1};
  put16(camera, 0x0201);
  for (int i = 0; i < 2; ++i) put8(camera, 0);   // no other terminal, no name
  for (int i = 0; i < 3; ++i) put16(camera, 0);  // no focal lengths
  put8(camera, 2);
  put16(camera, 0);
  Bytes bus = {3, 2};
  put16(bus, 0x0101);
  for (const unsigned value : {0U, 1U, 0U}) put8(bus, value);
  const Bytes units = [&] {
    Bytes both = class_descriptor(camera);
    append(both, class_descriptor(bus));
    return both;
  }();
  Bytes header = {1};
  put16(header, 0x0100);
  put16(header, static_cast<unsigned>(13 + units.size()));
  put32(header, 48'000'000);
  put8(header, 1);
  put8(header, 1);  // interface 1 streams
  Bytes all = class_descriptor(header);
  append(all, units);
  return all;
}

}  // namespace

UvcCamera::UvcCamera(std::uint16_t vendor, std::uint16_t product, const Mode& mode,
                     std::vector<std::vector<std::uint16_t>> pictures)
    : vendor_(vendor), product_(product), mode_(mode), pictures_(std::move(pictures)) {}

std::uint32_t UvcCamera::picture_bytes() const {
  return static_cast<std::uint32_t>(mode_.width * mode_.height) * 2;
}

std::uint32_t UvcCamera::interval() const {
  return 10'000'000U / static_cast<std::uint32_t>(mode_.rate);
}

Bytes UvcCamera::device_descriptor() const {
  Bytes bytes = {18, 1, 0, 2, 0xef, 2, 1, 64};
  put16(bytes, vendor_);
  put16(bytes, product_);
  put16(bytes, 0x0100);
  for (const unsigned value : {1U, 2U, 3U, 1U}) put8(bytes, value);
  return bytes;
}

Bytes UvcCamera::configuration_descriptor() const {
  Bytes format = {4, 1, 1};
  for (const unsigned value : kDepthGuid) put8(format, value);
  for (const unsigned value : {16U, 1U, 0U, 0U, 0U, 0U}) put8(format, value);
  Bytes frame = {5, 1, 0};
  put16(frame, static_cast<unsigned>(mode_.width));
  put16(frame, static_cast<unsigned>(mode_.height));
  for (int i = 0; i < 2; ++i) put32(frame, picture_bytes() * 8 * static_cast<std::uint32_t>(mode_.rate));
  put32(frame, picture_bytes());
  put32(frame, interval());
  put8(frame, 1);
  put32(frame, interval());
  Bytes formats = class_descriptor(format);
  append(formats, class_descriptor(frame));
  Bytes input = {1, 1};
  put16(input, static_cast<unsigned>(14 + formats.size()));
  for (const unsigned value : {kStreamEndpoint, 0U, 2U, 0U, 0U, 0U, 1U, 0U}) put8(input, value);

  Bytes body = {8, kAssociation, 0, 2, kVideo, kCollection, 0, 0};
  append(body, interface_descriptor(0, 0, kControlling));
  append(body, control_units());
  append(body, interface_descriptor(1, 1, kStreaming));
  append(body, class_descriptor(input));
  append(body, formats);
  for (const unsigned value : {7U, kEndpoint, kStreamEndpoint, kBulk}) put8(body, value);
  put16(body, kPacket);
  put8(body, 0);
  Bytes all = {9, 2};
  put16(all, static_cast<unsigned>(9 + body.size()));
  for (const unsigned value : {2U, 1U, 0U, 0x80U, 50U}) put8(all, value);
  append(all, body);
  return all;
}

std::string UvcCamera::text(int index) const {
  return index == 1 ? "Pliant tests" : index == 2 ? "Depth camera" : "0001";
}

void UvcCamera::configured() {
  offset_ = 0;
  hung_ = false;
}

Bytes UvcCamera::stream_settings() const {
  Bytes bytes = {0, 0, 1, 1};
  put32(bytes, interval());
  bytes.resize(18);
  put32(bytes, picture_bytes());
  put32(bytes, kPayload);
  return bytes;
}

std::optional<Bytes> UvcCamera::request(const UsbRequest& what, std::span<const std::uint8_t> /*data*/) {
  if ((what.index & 255) != 1) return std::nullopt;  // only the stream has controls
  if (what.request == kSet) return Bytes{};          // there is but one mode
  if (what.request == kGetInfo) return Bytes{3};
  if (what.request == kGetLength) return Bytes{kSettingsBytes, 0};
  if (what.request >= kGetCurrent && what.request <= kGetLast) return stream_settings();
  return std::nullopt;
}

std::optional<Bytes> UvcCamera::bulk(int /*endpoint*/, std::size_t most, std::int64_t now_ns,
                                     std::int64_t& due_ns) {
  constexpr std::size_t kHeader = 2;
  constexpr unsigned kEnds = 2, kHeaderEnds = 0x80;
  if (hung_) return std::nullopt;
  if (offset_ == 0 && now_ns < next_ns_) {
    due_ns = next_ns_;
    return std::nullopt;
  }
  const std::vector<std::uint16_t>& picture = pictures_[forth_and_back(count_, pictures_.size())];
  const std::size_t left = picture_bytes() - offset_,
                    part = std::min({left, most - kHeader, kPayload - kHeader});
  const void* pixels = picture.data();
  const auto* bytes = static_cast<const std::uint8_t*>(pixels) + offset_;
  Bytes data;
  data.reserve(kHeader + part);
  put8(data, kHeader);
  put8(data, kHeaderEnds | (count_ & 1U) | (part == left ? kEnds : 0U));
  data.insert(data.end(), bytes, bytes + part);
  offset_ += part;
  if (part < left) return data;
  offset_ = 0;
  ++count_;
  ++sent_;
  // At an even pace; what a busy machine could not keep up with is left out.
  const std::int64_t period = 1'000'000'000 / mode_.rate;
  next_ns_ = std::max(next_ns_ + period, now_ns);
  return data;
}

}  // namespace pliant::test

#include "tests/vm/virtual_usb_device.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>

#include "firmware-app/measure/clock.hpp"

namespace pliant::test {

namespace {

constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
constexpr int kHighSpeed = 3;           // USB_SPEED_HIGH
constexpr int kDeviceId = 1 << 16 | 2;  // bus 1, device 2 of the side that exports; any will do
constexpr std::size_t kHeaderBytes = 48;
constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinked = 4;
constexpr std::size_t kMostData = 1 << 20;

// Standard requests and descriptors (USB 2.0, tables 9-4 and 9-5).
constexpr std::uint8_t kGetStatus = 0, kClearFeature = 1, kSetFeature = 3, kGetDescriptor = 6,
                       kSetConfiguration = 9, kGetInterface = 10, kSetInterface = 11;
constexpr int kDevice = 1, kConfiguration = 2, kString = 3;

}  // namespace

void put8(Bytes& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>(value));
}
void put16(Bytes& bytes, unsigned value) {
  put8(bytes, value & 255U);
  put8(bytes, value >> 8);
}
void put32(Bytes& bytes, std::uint32_t value) {
  put16(bytes, value & 65535U);
  put16(bytes, value >> 16);
}

std::string VirtualUsbDevice::plug(int port) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return "no pair of sockets";
  // A port that was in use a moment ago is given free by a thread of the kernel's.
  const std::string text = std::to_string(port) + " " + std::to_string(ends[0]) + " " +
                           std::to_string(kDeviceId) + " " + std::to_string(kHighSpeed);
  int error = EBUSY;
  for (int i = 0; i < 50 && error != 0; ++i) {
    const int attach = open(kAttach, O_WRONLY | O_CLOEXEC);
    if (attach < 0) {
      error = errno;
      break;
    }
    const ssize_t written = write(attach, text.data(), text.size());
    error = written == static_cast<ssize_t>(text.size()) ? 0 : errno;
    close(attach);
    if (error != 0) usleep(100'000);
  }
  close(ends[0]);
  if (error != 0) {
    close(ends[1]);
    return std::string(kAttach) + ": " + std::strerror(error);  // NOLINT(concurrency-mt-unsafe)
  }
  socket_ = ends[1];
  stop_ = false;
  pending_.clear();
  thread_ = std::thread([this] { serve(); });
  return {};
}

void VirtualUsbDevice::unplug() {
  if (!thread_.joinable()) return;
  stop_ = true;
  shutdown(socket_, SHUT_RDWR);
  thread_.join();
  close(socket_);
  socket_ = -1;
}

void VirtualUsbDevice::serve() {
  try {
    while (!stop_) {
      const std::int64_t due = answer_bulk();
      pollfd waiting{socket_, POLLIN, 0};
      const std::int64_t wait_ms = std::clamp<std::int64_t>((due - monotonic_ns()) / 1'000'000 + 1, 0, 50);
      if (poll(&waiting, 1, static_cast<int>(wait_ms)) > 0) take_command();
    }
  } catch (const Gone&) {
  }
}

std::int64_t VirtualUsbDevice::answer_bulk() {
  std::int64_t next = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < pending_.size();) {
    const Pending asked = pending_[i];
    std::int64_t due = std::numeric_limits<std::int64_t>::max();
    const std::optional<Bytes> data = bulk(asked.endpoint, asked.bytes, monotonic_ns(), due);
    if (!data) {
      next = std::min(next, due);
      ++i;
      continue;
    }
    pending_.erase(pending_.begin() + static_cast<std::ptrdiff_t>(i));
    answer(asked.sequence, 0, *data, data->size());
  }
  return next;
}

void VirtualUsbDevice::take_command() {
  std::array<std::uint8_t, kHeaderBytes> header{};
  read_all(header);
  const auto word = [&header](std::size_t i) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | header[4 * i + k];
    return value;
  };
  const std::uint32_t command = word(0), sequence = word(1), endpoint = word(4);
  const bool in = word(3) != 0;
  if (command == kUnlink) return unlink(sequence, word(5));
  if (command != kSubmit) throw Gone();
  const std::size_t bytes = word(6);
  if (bytes > kMostData) throw Gone();
  Bytes data(in ? 0 : bytes);
  read_all(data);
  if (endpoint == 0) {
    const auto* setup = &header[40];
    const auto pair = [setup](int i) { return static_cast<std::uint16_t>(setup[i] | setup[i + 1] << 8); };
    return control(sequence, in, {setup[0], setup[1], pair(2), pair(4), pair(6)}, data);
  }
  if (in)
    pending_.push_back({sequence, static_cast<int>(endpoint), bytes});
  else
    answer(sequence, 0, {}, bytes);
}

void VirtualUsbDevice::control(std::uint32_t sequence, bool in, const UsbRequest& what,
                               std::span<const std::uint8_t> data) {
  constexpr int kKind = 0x60;  // of bmRequestType: 0 standard
  std::optional<Bytes> reply = (what.type & kKind) == 0 ? standard(what) : request(what, data);
  if (!reply) return answer(sequence, -EPIPE, {}, 0);
  if (in && reply->size() > what.length) reply->resize(what.length);
  answer(sequence, 0, in ? *reply : Bytes(), in ? reply->size() : data.size());
}

std::optional<Bytes> VirtualUsbDevice::standard(const UsbRequest& what) {
  switch (what.request) {
    case kGetDescriptor:
      return descriptor(what);
    case kGetStatus:
      return Bytes{0, 0};
    case kGetInterface:
      return Bytes{0};
    case kSetConfiguration:
      ++configurations_;
      configured();
      return Bytes{};
    case kClearFeature:
      halt_cleared();
      return Bytes{};
    case kSetFeature:
    case kSetInterface:
      return Bytes{};
    default:
      return std::nullopt;
  }
}

std::optional<Bytes> VirtualUsbDevice::descriptor(const UsbRequest& what) const {
  const int index = what.value & 255;
  switch (what.value >> 8) {
    case kDevice:
      return device_descriptor();
    case kConfiguration:
      return configuration_descriptor();
    case kString: {
      if (index == 0) return Bytes{4, kString, 9, 4};  // English (USA)
      const std::string letters = text(index);
      Bytes bytes;
      put8(bytes, static_cast<unsigned>(2 + 2 * letters.size()));
      put8(bytes, kString);
      for (const char letter : letters) put16(bytes, static_cast<unsigned char>(letter));
      return bytes;
    }
    default:
      return std::nullopt;  // no qualifier: there is no other speed
  }
}

void VirtualUsbDevice::unlink(std::uint32_t sequence, std::uint32_t meant) {
  const auto found = std::find_if(pending_.begin(), pending_.end(),
                                  [meant](const Pending& asked) { return asked.sequence == meant; });
  const bool there = found != pending_.end();
  if (there) pending_.erase(found);
  write_header(kUnlinked, sequence, there ? -ECONNRESET : 0, 0);
}

void VirtualUsbDevice::answer(std::uint32_t sequence, int status, std::span<const std::uint8_t> data,
                              std::size_t taken) {
  write_header(kSubmitted, sequence, status, taken);
  write_all(data);
}

void VirtualUsbDevice::write_header(std::uint32_t kind, std::uint32_t sequence, int status,
                                    std::size_t taken) {
  Bytes header;
  for (const std::uint32_t word : {kind, sequence, 0U, 0U, 0U, static_cast<std::uint32_t>(status),
                                   static_cast<std::uint32_t>(taken), 0U, 0U, 0U, 0U, 0U})
    for (const int shift : {24, 16, 8, 0}) put8(header, word >> shift & 255U);
  write_all(header);
}

void VirtualUsbDevice::read_all(std::span<std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw Gone();
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void VirtualUsbDevice::write_all(std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw Gone();
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

}  // namespace pliant::test

#include "drivers/v4l2/v4l2_format.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <bit>

#include "core/limits.hpp"

namespace pliant {

namespace {

constexpr std::uint32_t kY12P = v4l2_fourcc('Y', '1', '2', 'P');  // newer than Debian 12's kernel headers

constexpr std::array<V4l2Format, 5> kFormats = {
    {{"Z16", V4L2_PIX_FMT_Z16, V4l2Packing::words, false},
     {"INZI", V4L2_PIX_FMT_INZI, V4l2Packing::words, true},
     {"Y16", V4L2_PIX_FMT_Y16, V4l2Packing::words, false},
     {"Y12P", kY12P, V4l2Packing::mipi12, false},
     {"Y10B", V4L2_PIX_FMT_Y10BPACK, V4l2Packing::bits10, false}}};

std::size_t packed_bytes(V4l2Packing packing, std::size_t width) {
  switch (packing) {
    case V4l2Packing::mipi12:
      return (width * 12 + 7) / 8;
    case V4l2Packing::bits10:
      return (width * 10 + 7) / 8;
    case V4l2Packing::words:
      break;
  }
  return 2 * width;
}

std::uint16_t byte_at(std::span<const std::byte> row, std::size_t i) {
  return i < row.size() ? std::to_integer<std::uint16_t>(row[i]) : std::uint16_t{0};
}

std::uint16_t reading_at(V4l2Packing packing, std::span<const std::byte> row, std::size_t u) {
  switch (packing) {
    case V4l2Packing::mipi12: {
      const std::size_t pair = u / 2 * 3;
      const unsigned low = byte_at(row, pair + 2);
      return static_cast<std::uint16_t>(byte_at(row, pair + u % 2) << 4 |
                                        (u % 2 == 0 ? low & 15U : low >> 4));
    }
    case V4l2Packing::bits10: {
      const std::size_t bit = u * 10, at = bit / 8;
      const unsigned two = static_cast<unsigned>(byte_at(row, at)) << 8 | byte_at(row, at + 1);
      return static_cast<std::uint16_t>(two >> (6 - bit % 8) & 1023U);
    }
    case V4l2Packing::words:
      break;
  }
  return static_cast<std::uint16_t>(byte_at(row, 2 * u) | byte_at(row, 2 * u + 1) << 8);
}

}  // namespace

std::span<const V4l2Format> v4l2_formats() {
  return kFormats;
}

const V4l2Format* find_v4l2_format(std::uint32_t code) {
  const auto* found =
      std::find_if(kFormats.begin(), kFormats.end(), [code](const V4l2Format& f) { return f.code == code; });
  return found == kFormats.end() ? nullptr : found;
}

const V4l2Format* find_v4l2_format(std::string_view name) {
  const auto* found =
      std::find_if(kFormats.begin(), kFormats.end(), [name](const V4l2Format& f) { return f.name == name; });
  return found == kFormats.end() ? nullptr : found;
}

std::string fourcc_text(std::uint32_t code) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const auto c = static_cast<char>(code >> (8 * i) & 0x7FU);
    text += c >= ' ' && c < 0x7f ? c : '?';
  }
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

Result<V4l2Layout> v4l2_layout(std::uint32_t code, std::uint32_t width, std::uint32_t height,
                               std::uint32_t bytes_per_line, std::uint32_t image_bytes) {
  const V4l2Format* format = find_v4l2_format(code);
  if (format == nullptr)
    return Error{ErrorKind::device, fmt::format("v4l2: {} is no depth format", fourcc_text(code))};
  if (width < limits::kMinFrameWidth || width > limits::kMaxFrameWidth || height < limits::kMinFrameHeight ||
      height > limits::kMaxFrameHeight)
    return Error{ErrorKind::device, fmt::format("v4l2: frames of {}x{} are out of range", width, height)};
  V4l2Layout layout{format, width, height, bytes_per_line, 0, 0};
  const std::size_t least = packed_bytes(format->packing, width);
  // Some drivers give the bytes of both halves' pixels for a line of INZI; the picture's size tells.
  if (format->second_half && layout.row_bytes >= 2 * least) layout.row_bytes /= 2;
  if (layout.row_bytes == 0) layout.row_bytes = least;
  if (layout.row_bytes < least || layout.row_bytes > 16 * least)
    return Error{ErrorKind::device, fmt::format("v4l2: {} bytes a line cannot hold {} readings of {}",
                                                bytes_per_line, width, format->name)};
  const std::size_t half = layout.row_bytes * height;
  layout.begin = format->second_half ? half : 0;
  layout.bytes = layout.begin + half - layout.row_bytes + least;
  if (image_bytes != 0 && image_bytes < layout.bytes)
    return Error{ErrorKind::device, fmt::format("v4l2: {} bytes a frame are too few for {}x{} {}",
                                                image_bytes, width, height, format->name)};
  return layout;
}

std::optional<const std::uint16_t*> v4l2_readings_in_place(const V4l2Layout& layout,
                                                           std::span<const std::byte> buffer) {
  if constexpr (std::endian::native != std::endian::little) return std::nullopt;
  if (layout.format->packing != V4l2Packing::words || layout.row_bytes % 2 != 0) return std::nullopt;
  const void* first = buffer.data() + layout.begin;
  if (std::bit_cast<std::uintptr_t>(first) % alignof(std::uint16_t) != 0) return std::nullopt;
  return static_cast<const std::uint16_t*>(first);
}

void v4l2_unpack(const V4l2Layout& layout, std::span<const std::byte> buffer, std::span<std::uint16_t> out) {
  const std::size_t row_length = packed_bytes(layout.format->packing, layout.width);
  for (std::size_t v = 0; v < layout.height; ++v) {
    const std::span<const std::byte> row = buffer.subspan(layout.begin + v * layout.row_bytes, row_length);
    std::uint16_t* to = out.data() + v * layout.width;
    for (std::size_t u = 0; u < layout.width; ++u) to[u] = reading_at(layout.format->packing, row, u);
  }
}

}  // namespace pliant

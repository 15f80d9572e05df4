// The depth formats of V4L2 and how their readings lie in a buffer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "drivers/common/result.hpp"

namespace pliant {

/// How a reading is stored.
enum class V4l2Packing : std::uint8_t {
  words,   ///< 16 bits, low byte first: Z16, Y16
  mipi12,  ///< two readings in three bytes, the high bits first, the low ones shared: Y12P
  bits10   ///< ten bits each, one after the other, high bits first: Y10B
};

struct V4l2Format {
  std::string_view name;  ///< as the user writes it, the four letters without blanks at the end
  std::uint32_t code;     ///< V4L2_PIX_FMT_…
  V4l2Packing packing;
  bool second_half;  ///< depth stands behind a picture of the same size: INZI
};

/// In the order in which they are preferred.
[[nodiscard]] std::span<const V4l2Format> v4l2_formats();
[[nodiscard]] const V4l2Format* find_v4l2_format(std::uint32_t code);
[[nodiscard]] const V4l2Format* find_v4l2_format(std::string_view name);
/// "YUYV", with '?' for what cannot be printed.
[[nodiscard]] std::string fourcc_text(std::uint32_t code);

/// Where the readings of a picture are.
struct V4l2Layout {
  const V4l2Format* format = nullptr;
  std::uint32_t width = 0, height = 0;
  std::size_t row_bytes = 0;  ///< from one row to the next
  std::size_t begin = 0;      ///< of the first row
  std::size_t bytes = 0;      ///< that a whole picture needs, from the buffer's begin
};

/// From what the driver says of its format; `bytes_per_line` 0 means no padding. An error where the numbers
/// cannot be true or the size is out of the program's limits.
[[nodiscard]] Result<V4l2Layout> v4l2_layout(std::uint32_t code, std::uint32_t width, std::uint32_t height,
                                             std::uint32_t bytes_per_line, std::uint32_t image_bytes);

/// The readings inside the buffer, where they can be used as they are: in words, on even addresses.
[[nodiscard]] std::optional<const std::uint16_t*> v4l2_readings_in_place(const V4l2Layout& layout,
                                                                         std::span<const std::byte> buffer);

/// Writes width * height readings. The buffer holds at least layout.bytes.
void v4l2_unpack(const V4l2Layout& layout, std::span<const std::byte> buffer, std::span<std::uint16_t> out);

}  // namespace pliant

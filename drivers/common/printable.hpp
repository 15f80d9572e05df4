// Text from a file, or the name of one, inside a message or a picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace pliant {

/// Bytes of the UTF-8 character that `text` begins with; 0 where it begins with none that XML may hold, or
/// with a control character.
[[nodiscard]] inline std::size_t printable_bytes(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  if (text.empty()) return 0;
  const std::uint32_t first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  std::uint32_t code = first & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  return code < kLeast[length] || code > 0x10ffff || surrogate || code == 0xfffe || code == 0xffff ? 0
                                                                                                   : length;
}

/// `text` with '?' for control characters and for what is no UTF-8, cut after `most` bytes at the most, so
/// that a message stays one short line.
inline std::string printable(std::string_view text, std::size_t most = 60) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = printable_bytes(text);
    if (out.size() + (length == 0 ? 1 : length) > most) return out + "...";
    if (length == 0) {
      out += '?';
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

}  // namespace pliant

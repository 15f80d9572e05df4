#include "drivers/lcm/wire.hpp"

#include <algorithm>

namespace pliant::wire {

void Writer::put_string(std::string_view text, std::size_t limit) noexcept {
  text = text.substr(0, text.find('\0'));
  if (text.size() > limit) {
    std::size_t length = limit;
    // Bytes 10xxxxxx continue a character.
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U) --length;
    text = text.substr(0, length);
  }
  if (out_.size() - at_ < sizeof(std::int32_t) + text.size() + 1) {
    ok_ = false;
    return;
  }
  put<std::int32_t>(static_cast<std::int32_t>(text.size() + 1));
  if (!text.empty()) std::memcpy(out_.data() + at_, text.data(), text.size());
  at_ += text.size();
  out_[at_++] = 0;
}

std::string_view Reader::get_string() noexcept {
  const std::int32_t length = get<std::int32_t>();
  if (!ok_ || length < 1) {
    ok_ = false;
    return {};
  }
  const auto bytes = get_bytes(static_cast<std::size_t>(length));
  if (!ok_ || std::find(bytes.begin(), bytes.end(), std::uint8_t{0}) != bytes.end() - 1) {
    ok_ = false;
    return {};
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size() - 1};
}

std::size_t Reader::get_count(std::size_t element_bytes, std::size_t limit) noexcept {
  const std::int32_t count = get<std::int32_t>();
  if (!ok_ || count < 0 || static_cast<std::size_t>(count) > limit ||
      static_cast<std::size_t>(count) * element_bytes > in_.size() - at_) {
    ok_ = false;
    return 0;
  }
  return static_cast<std::size_t>(count);
}

}  // namespace pliant::wire

#include "drivers/geometry_files/numbers.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <limits>

namespace pliant {

namespace {

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\n' || c == '\r';
}

template <typename Whole, typename Number>
double as(std::uint64_t bits) {
  return static_cast<double>(std::bit_cast<Number>(static_cast<Whole>(bits)));
}

}  // namespace

TextCursor::TextCursor(std::span<const std::byte> data)
    : text_(static_cast<const char*>(static_cast<const void*>(data.data())), data.size()) {}

bool TextCursor::next_line(std::string_view& line) {
  if (position_ == text_.size()) return false;
  if (!inside_line_) ++line_;
  inside_line_ = false;
  const std::size_t end = text_.find_first_of("\n\r", position_);
  line = text_.substr(position_, end - position_);
  if (end == std::string_view::npos) {
    position_ = text_.size();
    return true;
  }
  position_ = end + 1;
  if (text_[end] == '\r' && position_ < text_.size() && text_[position_] == '\n') ++position_;
  return true;
}

bool TextCursor::next_word(std::string_view& word) {
  while (position_ < text_.size() && blank(text_[position_])) {
    if (text_[position_] == '\n') {
      if (!inside_line_) ++line_;
      inside_line_ = false;
    }
    ++position_;
  }
  if (position_ == text_.size()) return false;
  if (!inside_line_) ++line_;
  inside_line_ = true;
  const std::size_t begin = position_;
  while (position_ < text_.size() && !blank(text_[position_])) ++position_;
  word = text_.substr(begin, position_ - begin);
  return true;
}

bool take_word(std::string_view& rest, std::string_view& word) {
  std::size_t begin = 0;
  while (begin < rest.size() && blank(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !blank(rest[end])) ++end;
  word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return !word.empty();
}

bool to_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.empty() || word.front() == '+') return false;
  const std::from_chars_result read = std::from_chars(word.data(), word.data() + word.size(), value);
  if (read.ptr != word.data() + word.size()) return false;
  if (read.ec == std::errc::result_out_of_range) {
    const bool tiny = word.find("e-") != std::string_view::npos ||
                      word.find("E-") != std::string_view::npos ||
                      word.find_first_of("eE") == std::string_view::npos;
    value = tiny ? 0 : std::numeric_limits<double>::infinity();
    return true;
  }
  return read.ec == std::errc();
}

bool to_integer(std::string_view word, std::int64_t& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.empty() || word.front() == '+') return false;
  const std::from_chars_result read = std::from_chars(word.data(), word.data() + word.size(), value);
  return read.ec == std::errc() && read.ptr == word.data() + word.size();
}

float to_float(double value) {
  constexpr double most = static_cast<double>(std::numeric_limits<float>::max());
  if (value > most) return std::numeric_limits<float>::infinity();
  if (value < -most) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(value);
}

std::string_view shown(std::string_view word) {
  std::size_t length = 0;
  while (length < word.size() && length < 24 && word[length] > ' ' && word[length] < 127) ++length;
  return word.substr(0, length);
}

std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

double read_number(const std::byte* bytes, NumberType type, bool big_endian) {
  const std::size_t size = size_of(type);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t shift = 8 * (big_endian ? size - 1 - i : i);
    bits |= std::to_integer<std::uint64_t>(bytes[i]) << shift;
  }
  switch (type) {
    case NumberType::int8:
      return as<std::uint8_t, std::int8_t>(bits);
    case NumberType::uint8:
    case NumberType::uint16:
    case NumberType::uint32:
    case NumberType::uint64:
      return static_cast<double>(bits);
    case NumberType::int16:
      return as<std::uint16_t, std::int16_t>(bits);
    case NumberType::int32:
      return as<std::uint32_t, std::int32_t>(bits);
    case NumberType::int64:
      return as<std::uint64_t, std::int64_t>(bits);
    case NumberType::float32:
      return as<std::uint32_t, float>(bits);
    case NumberType::float64:
      return as<std::uint64_t, double>(bits);
  }
  return 0;
}

}  // namespace pliant

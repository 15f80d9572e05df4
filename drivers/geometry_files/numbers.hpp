// Bounded reading of text and binary numbers; independent of the locale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace pliant {

/// Walks over text line by line, token by token.
class TextCursor {
 public:
  explicit TextCursor(std::span<const std::byte> data);
  explicit TextCursor(std::string_view text) : text_(text) {}

  /// The next line without its end (\n, \r\n or \r); false at the end of the text.
  bool next_line(std::string_view& line);
  /// The next word, over line ends; false at the end of the text.
  bool next_word(std::string_view& word);
  /// Number of the line last read from, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }
  /// Bytes not yet read.
  [[nodiscard]] std::size_t remaining() const { return text_.size() - position_; }
  [[nodiscard]] std::size_t position() const { return position_; }
  void set_first_line(std::size_t line) { line_ = line; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
  bool inside_line_ = false;  // next_word() stopped before the end of line_
};

/// Takes the next word off the front of `rest`; false when there is none.
bool take_word(std::string_view& rest, std::string_view& word);

/// A whole word as a number; false when it is none. Values beyond a double become infinite or zero.
bool to_number(std::string_view word, double& value);
bool to_integer(std::string_view word, std::int64_t& value);
/// Infinite where it does not fit.
float to_float(double value);
/// A word fit for an error message: printable and short.
std::string_view shown(std::string_view word);

/// The types of binary files.
enum class NumberType : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};
[[nodiscard]] std::size_t size_of(NumberType type);
/// The number at `bytes`, which must hold size_of(type) bytes. 64-bit integers are rounded to double.
[[nodiscard]] double read_number(const std::byte* bytes, NumberType type, bool big_endian);

}  // namespace pliant

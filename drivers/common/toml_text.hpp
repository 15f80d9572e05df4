// TOML through toml++ 3.3, kept from texts that it cannot bear.
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/common/printable.hpp"
#include "drivers/common/result.hpp"

#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

namespace pliant {

struct TextPlace {
  std::size_t line = 1, column = 1;  ///< counted in characters, from 1
};

[[nodiscard]] inline bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
}

/// How many bytes the character takes that `text` begins with; 0 where that is not UTF-8 (Unicode, table
/// 3-7).
[[nodiscard]] inline std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const unsigned char first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  const auto all_continue = [&](std::size_t length) {
    for (std::size_t i = 1; i < length; ++i)
      if ((byte(i) & 0xC0) != 0x80) return false;
    return true;
  };
  if (first >= 0xC2 && first <= 0xDF) return all_continue(2) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool longer_than_needed = first == 0xE0 && second < 0xA0;
    const bool surrogate = first == 0xED && second > 0x9F;
    return all_continue(3) && !longer_than_needed && !surrogate ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool longer_than_needed = first == 0xF0 && second < 0x90;
    const bool beyond_unicode = first == 0xF4 && second > 0x8F;
    return all_continue(4) && !longer_than_needed && !beyond_unicode ? 4 : 0;
  }
  return 0;
}

/// `text` with an 'x' for each character beyond ASCII: the same TOML but for the letters of its strings.
/// (Quoted keys beyond ASCII may become alike; no file of ours has any.)
/// `broken` is set to the place of the first byte that is not UTF-8.
[[nodiscard]] inline std::string in_ascii(std::string_view text, std::optional<TextPlace>& broken) {
  std::string ascii;
  TextPlace place;
  broken.reset();
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = character_length(text.substr(i));
    if (length == 0) {
      broken = place;
      return ascii;
    }
    ascii.push_back(length == 1 ? text[i] : 'x');
    ++place.column;
    if (text[i] == '\n') place = {place.line + 1, 1};
    i += length;
  }
  return ascii;
}

/// The first character beyond ASCII in valid TOML that stands outside comments and strings of one line. TOML
/// allows them in long strings too, but behind a backslash that ends a line there toml++ stumbles over them.
[[nodiscard]] inline std::optional<TextPlace> stray_character(std::string_view text) {
  TextPlace place;
  char quote = 0;  // what the string here began with; '#' in a comment
  bool is_long = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto pass = [&](std::size_t more) {
      i += more;
      place.column += more;
    };
    if (c == '\n') {
      if (!is_long) quote = 0;
      place = {place.line + 1, 1};
      continue;
    }
    const bool threefold =
        (c == '"' || c == '\'') && text.substr(i, 3) == std::string_view(c == '"' ? "\"\"\"" : "'''");
    if ((quote == 0 || is_long) && static_cast<unsigned char>(c) >= 0x80) return place;
    if (quote == 0) {
      if (c == '#' || c == '"' || c == '\'') quote = c;
      is_long = threefold;
      if (threefold) pass(2);
    } else if (quote == '"' && c == '\\' && i + 1 < text.size() && text[i + 1] != '\n' &&
               static_cast<unsigned char>(text[i + 1]) < 0x80) {
      pass(1);
    } else if (c == quote && c != '#' && (!is_long || threefold)) {
      // A long string may end in one or two quotes of its own.
      if (is_long) pass(2);
      for (int own = 0; is_long && own < 2 && i + 1 < text.size() && text[i + 1] == quote; ++own) pass(1);
      quote = 0;
      is_long = false;
    }
    if (!continues_character(c)) ++place.column;
  }
  return std::nullopt;
}

/// The tables of `text`. An error names the place in `name` and what is wrong there.
[[nodiscard]] inline Result<toml::table> parse_toml(std::string_view text, std::string_view name) {
  const auto fault = [&](const auto& place, std::string_view what) {
    return Error{ErrorKind::bad_input,
                 fmt::format("{}:{}:{}: not valid TOML: {}", name, place.line, place.column, what)};
  };
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);  // byte order mark
  std::optional<TextPlace> broken;
  const std::string ascii = in_ascii(text, broken);
  if (broken) return fault(*broken, "not UTF-8; save the file as UTF-8 text");
  if (const std::optional<TextPlace> stray = stray_character(text))
    return fault(*stray, "a character beyond ASCII outside the quotes of one line");
  // Undefined behaviour awaits toml++ where characters beyond ASCII are no part of a string. Only where all
  // else is well formed is it certain what is.
  if (const toml::parse_result form = toml::parse(ascii); !form)
    return fault(form.error().source().begin, printable(form.error().description()));
  toml::parse_result parsed = toml::parse(text);
  if (!parsed) return fault(parsed.error().source().begin, printable(parsed.error().description()));
  return std::move(parsed).table();
}

}  // namespace pliant

// What toml++ 3.3 must not be given.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace pliant {

struct TextPlace {
  std::size_t line = 1, column = 1;
};

/// The first character beyond ASCII that stands outside comments and one-line strings. TOML allows none
/// there, but toml++ 3.3 runs into undefined behaviour over some of them ("größe = 1") before it can say so.
inline std::optional<TextPlace> stray_character(std::string_view text) {
  enum class Where { plain, comment, basic, literal };
  Where where = Where::plain;
  TextPlace place;
  char before = '\n';  // the last character that is no blank; a string only begins behind some of them
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);  // byte order mark
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool beyond = static_cast<unsigned char>(c) >= 0x80;
    if (c == '\n') {
      where = Where::plain;
      before = c;
      ++place.line;
      place.column = 1;
      continue;
    }
    switch (where) {
      case Where::plain: {
        if (beyond) return place;
        if (c == '#') where = Where::comment;
        const bool begins = std::string_view("\n=[{,.").find(before) != std::string_view::npos;
        // The text of a long string (three quotes) counts as plain.
        const bool is_long = text.substr(i, 3) == "\"\"\"" || text.substr(i, 3) == "'''";
        if (begins && !is_long && c == '"') where = Where::basic;
        if (begins && !is_long && c == '\'') where = Where::literal;
        if (c != ' ' && c != '\t') before = c;
        break;
      }
      case Where::comment:
        break;
      case Where::basic:
        if (c == '\\' && i + 1 < text.size() && text[i + 1] != '\n') {
          ++i;
          ++place.column;
        } else if (c == '"') {
          where = Where::plain;
        }
        break;
      case Where::literal:
        if (c == '\'') where = Where::plain;
        break;
    }
    if (!beyond || (static_cast<unsigned char>(c) & 0xC0) == 0xC0) ++place.column;
  }
  return std::nullopt;
}

}  // namespace pliant

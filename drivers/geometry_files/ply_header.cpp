#include "drivers/geometry_files/ply_header.hpp"

#include <array>
#include <utility>

#include "drivers/geometry_files/finish.hpp"

namespace pliant {

namespace {

/// More elements or properties than any real file has.
constexpr std::size_t kMaxElements = 64, kMaxProperties = 256;

bool number_type(std::string_view word, NumberType& type) {
  using enum NumberType;
  constexpr std::array<std::pair<std::string_view, NumberType>, 18> names = {{{"char", int8},
                                                                              {"int8", int8},
                                                                              {"uchar", uint8},
                                                                              {"uint8", uint8},
                                                                              {"short", int16},
                                                                              {"int16", int16},
                                                                              {"ushort", uint16},
                                                                              {"uint16", uint16},
                                                                              {"int", int32},
                                                                              {"int32", int32},
                                                                              {"uint", uint32},
                                                                              {"uint32", uint32},
                                                                              {"int64", int64},
                                                                              {"uint64", uint64},
                                                                              {"float", float32},
                                                                              {"float32", float32},
                                                                              {"double", float64},
                                                                              {"float64", float64}}};
  for (const auto& [known, value] : names)
    if (word == known) {
      type = value;
      return true;
    }
  return false;
}

/// What is wrong with the property line (its first word already taken), or null.
const char* read_property(std::string_view line, PlyProperty& property) {
  std::string_view word;
  if (!take_word(line, word)) return "a property without a type";
  property.is_list = word == "list";
  if (property.is_list) {
    if (!take_word(line, word) || !number_type(word, property.count_type) ||
        property.count_type == NumberType::float32 || property.count_type == NumberType::float64)
      return "a list needs an integer type for its length";
    if (!take_word(line, word)) return "a list without a type of its items";
  }
  if (!number_type(word, property.type)) return "an unknown type of a property";
  if (!take_word(line, word)) return "a property without a name";
  property.name = word;
  return nullptr;
}

const char* read_element(std::string_view line, PlyElement& element) {
  std::string_view word;
  if (!take_word(line, word)) return "an element without a name";
  element.name = word;
  std::int64_t count = 0;
  if (!take_word(line, word) || !to_integer(word, count) || count < 0)
    return "an element needs a count (a whole number >= 0)";
  element.count = static_cast<std::uint64_t>(count);
  return nullptr;
}

const char* read_format(std::string_view line, PlyEncoding& encoding) {
  std::string_view word;
  take_word(line, word);
  if (word == "ascii") {
    encoding = PlyEncoding::ascii;
  } else if (word == "binary_little_endian") {
    encoding = PlyEncoding::little_endian;
  } else if (word == "binary_big_endian") {
    encoding = PlyEncoding::big_endian;
  } else {
    return "the format must be ascii, binary_little_endian or binary_big_endian";
  }
  return nullptr;
}

}  // namespace

int PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return static_cast<int>(i);
  return -1;
}

std::uint64_t PlyElement::least_bytes(bool ascii) const {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += ascii ? 2 : size_of(property.is_list ? property.count_type : property.type);
  return bytes;
}

Result<PlyHeader> parse_ply_header(std::span<const std::byte> data, std::string_view name) {
  TextCursor cursor(data);
  std::string_view line, word;
  if (!cursor.next_line(line) || !take_word(line, word) || word != "ply")
    return line_error(name, 1, "a PLY file begins with 'ply'; this one does not");
  PlyHeader header;
  bool format_seen = false;
  while (cursor.next_line(line)) {
    const char* fault = nullptr;
    if (!take_word(line, word) || word == "comment" || word == "obj_info") continue;
    if (word == "end_header") {
      if (!format_seen) return line_error(name, cursor.line(), "the header has no 'format' line");
      header.bytes = cursor.position();
      header.lines = cursor.line();
      return header;
    }
    if (word == "format") {
      fault = read_format(line, header.encoding);
      format_seen = true;
    } else if (word == "element") {
      if (header.elements.size() == kMaxElements) return line_error(name, cursor.line(), "too many elements");
      fault = read_element(line, header.elements.emplace_back());
    } else if (word == "property") {
      if (header.elements.empty()) return line_error(name, cursor.line(), "a property before any element");
      std::vector<PlyProperty>& properties = header.elements.back().properties;
      if (properties.size() == kMaxProperties) return line_error(name, cursor.line(), "too many properties");
      fault = read_property(line, properties.emplace_back());
    } else {
      return line_error(name, cursor.line(), fmt::format("unknown word '{}' in the header", shown(word)));
    }
    if (fault != nullptr) return line_error(name, cursor.line(), fault);
  }
  return line_error(name, cursor.line(), "the header has no 'end_header'; is the file cut short?");
}

}  // namespace pliant

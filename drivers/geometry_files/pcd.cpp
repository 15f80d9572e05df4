// PCD, the format of the Point Cloud Library.
#include <algorithm>
#include <array>

#include "drivers/geometry_files/finish.hpp"
#include "drivers/geometry_files/lzf.hpp"
#include "drivers/geometry_files/numbers.hpp"
#include "drivers/geometry_files/parsers.hpp"

namespace pliant {

namespace {

constexpr std::size_t kMaxFields = 256;
constexpr std::int64_t kMaxCount = 4096;  // values of one field

struct PcdField {
  std::string name;
  std::int64_t size = 4;
  char kind = 'F';
  std::int64_t count = 1;
  NumberType type = NumberType::float32;
  std::size_t offset = 0;  // bytes in a point
  std::size_t column = 0;  // words in a line
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::int64_t width = -1, height = 1, points = -1;
  std::string data;
  std::size_t bytes = 0, lines = 0;
  std::size_t point_bytes = 0, point_words = 0;
};

const char* number_type(const PcdField& field, NumberType& type) {
  using enum NumberType;
  constexpr std::array<NumberType, 4> whole = {int8, int16, int32, int64};
  constexpr std::array<NumberType, 4> natural = {uint8, uint16, uint32, uint64};
  constexpr const char* fault = "SIZE and TYPE must be 1, 2, 4, 8 of I or U, or 4, 8 of F";
  if (field.size != 1 && field.size != 2 && field.size != 4 && field.size != 8) return fault;
  const std::size_t step = field.size == 1 ? 0 : field.size == 2 ? 1 : field.size == 4 ? 2 : 3;
  if (field.kind == 'F' && field.size >= 4) {
    type = field.size == 4 ? float32 : float64;
  } else if (field.kind == 'I') {
    type = whole[step];
  } else if (field.kind == 'U') {
    type = natural[step];
  } else {
    return fault;
  }
  return nullptr;
}

/// Reads one line of the header. What is wrong with it, or null.
const char* read_header_line(std::string_view key, std::string_view line, PcdHeader& header) {
  std::string_view word;
  std::int64_t number = 0;
  if (key == "FIELDS" || key == "COLUMNS") {
    header.fields.clear();
    while (take_word(line, word)) {
      if (header.fields.size() == kMaxFields) return "too many fields";
      header.fields.emplace_back().name = word;
    }
  } else if (key == "SIZE" || key == "COUNT") {
    for (PcdField& field : header.fields) {
      if (!take_word(line, word) || !to_integer(word, number) || number < 1 || number > kMaxCount)
        return "a whole number >= 1 is wanted for each of the FIELDS";
      (key == "SIZE" ? field.size : field.count) = number;
    }
  } else if (key == "TYPE") {
    for (PcdField& field : header.fields) {
      if (!take_word(line, word) || word.size() != 1) return "a letter is wanted for each of the FIELDS";
      field.kind = word.front();
    }
  } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
    if (!take_word(line, word) || !to_integer(word, number) || number < 0 || number > 0xFFFFFFFFLL)
      return "a whole number >= 0 is wanted here";
    (key == "WIDTH" ? header.width : key == "HEIGHT" ? header.height : header.points) = number;
  } else if (key == "DATA") {
    if (!take_word(line, word)) return "DATA must be ascii, binary or binary_compressed";
    header.data = word;
  } else if (key != "VERSION" && key != "VIEWPOINT") {
    return "unknown word in the header";
  }
  return nullptr;
}

Outcome check_header(PcdHeader& header, std::string_view name) {
  if (header.fields.empty()) return file_error(name, "its header has no FIELDS");
  if (header.width >= 0 && header.height > 0 && header.width > 0xFFFFFFFFLL / header.height)
    return file_error(name, "WIDTH times HEIGHT is too large");
  if (header.points < 0 && header.width >= 0) header.points = header.width * header.height;
  if (header.points < 0) return file_error(name, "its header has neither POINTS nor WIDTH");
  if (header.width >= 0 && header.width * header.height != header.points)
    return file_error(name, fmt::format("its header contradicts itself: WIDTH {} x HEIGHT {} but POINTS {}",
                                        header.width, header.height, header.points));
  for (PcdField& field : header.fields) {
    if (const char* fault = number_type(field, field.type); fault != nullptr) return file_error(name, fault);
    field.offset = header.point_bytes;
    field.column = header.point_words;
    header.point_bytes += static_cast<std::size_t>(field.size * field.count);
    header.point_words += static_cast<std::size_t>(field.count);
  }
  return success();
}

Result<PcdHeader> read_header(std::span<const std::byte> data, std::string_view name) {
  PcdHeader header;
  TextCursor cursor(data);
  std::string_view line, word;
  while (header.data.empty()) {
    if (!cursor.next_line(line))
      return line_error(name, cursor.line(), "the header has no DATA line; is the file cut short?");
    if (!take_word(line, word) || word.starts_with('#')) continue;
    if (const char* fault = read_header_line(word, line, header); fault != nullptr)
      return line_error(name, cursor.line(), fmt::format("{}: {}", shown(word), fault));
  }
  header.bytes = cursor.position();
  header.lines = cursor.line();
  if (const Outcome checked = check_header(header, name); !checked) return checked.error();
  return header;
}

/// Where x, y, z and, when there are all three, the normal stand among the fields.
struct Columns {
  std::array<const PcdField*, 6> field{};
  [[nodiscard]] bool normals() const { return field[3] && field[4] && field[5]; }
};

Outcome find_columns(const PcdHeader& header, std::string_view name, Columns& columns) {
  constexpr std::array<std::string_view, 6> names = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  for (std::size_t k = 0; k < 6; ++k) {
    for (const PcdField& field : header.fields)
      if (columns.field[k] == nullptr && field.name == names[k]) columns.field[k] = &field;
    if (k < 3 && columns.field[k] == nullptr)
      return file_error(name, fmt::format("its FIELDS have no '{}'", names[k]));
  }
  return success();
}

/// Adds a point; `number(field)` gives its values.
template <typename Number>
void add_point(Geometry& geometry, const Columns& columns, Number number) {
  std::array<float, 6> value{};
  for (std::size_t k = 0; k < (columns.normals() ? 6U : 3U); ++k)
    value[k] = to_float(number(*columns.field[k]));
  geometry.vertices.push_back({value[0], value[1], value[2]});
  if (columns.normals()) geometry.normals.push_back({value[3], value[4], value[5]});
}

Outcome read_ascii(std::span<const std::byte> data, const PcdHeader& header, const Columns& columns,
                   std::string_view name, Geometry& geometry) {
  TextCursor cursor(data.subspan(header.bytes));
  cursor.set_first_line(header.lines);
  const auto count = static_cast<std::size_t>(header.points);
  if (count > (cursor.remaining() + 1) / (2 * header.point_words))
    return line_error(name, cursor.line(),
                      fmt::format("{} points are more than the file has room for; is it cut short?", count));
  geometry.vertices.reserve(count);
  std::string_view line;
  std::vector<double> numbers(header.point_words);
  for (std::size_t i = 0; i < count; ++i) {
    std::string_view word, look;
    do {
      if (!cursor.next_line(line))
        return line_error(name, cursor.line(),
                          fmt::format("the file ends after {} of {} points; is it cut short?", i, count));
      look = line;
    } while (!take_word(look, word) || word.starts_with('#'));
    for (double& number : numbers)
      if (!take_word(line, word) || !to_number(word, number))
        return line_error(name, cursor.line(), fmt::format("a point needs {} numbers", numbers.size()));
    add_point(geometry, columns, [&](const PcdField& field) { return numbers[field.column]; });
  }
  return success();
}

Outcome read_binary(std::span<const std::byte> data, const PcdHeader& header, const Columns& columns,
                    std::string_view name, Geometry& geometry) {
  const auto count = static_cast<std::size_t>(header.points);
  const std::size_t room = (data.size() - header.bytes) / header.point_bytes;
  if (count > room)
    return byte_error(name, header.bytes,
                      fmt::format("the header says {} points, but the file has room for {}; is it cut short?",
                                  count, room));
  geometry.vertices.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    add_point(geometry, columns, [&](const PcdField& field) {
      return read_number(data.data() + header.bytes + i * header.point_bytes + field.offset, field.type,
                         false);
    });
  return success();
}

/// Two sizes, then LZF of all values of the first field, all of the second, …
Outcome read_compressed(std::span<const std::byte> data, const PcdHeader& header, const Columns& columns,
                        std::string_view name, Geometry& geometry) {
  if (data.size() - header.bytes < 8)
    return byte_error(name, header.bytes, "the file ends before its compressed data; is it cut short?");
  const auto size_at = [&](std::size_t at) {
    return static_cast<std::size_t>(read_number(data.data() + at, NumberType::uint32, false));
  };
  const std::size_t packed = size_at(header.bytes), unpacked = size_at(header.bytes + 4);
  if (packed > data.size() - header.bytes - 8)
    return byte_error(name, header.bytes,
                      fmt::format("{} compressed bytes should follow, but only {} do; is the file cut short?",
                                  packed, data.size() - header.bytes - 8));
  const auto count = static_cast<std::size_t>(header.points);
  if (count > unpacked / header.point_bytes || unpacked != count * header.point_bytes)
    return byte_error(name, header.bytes + 4,
                      fmt::format("{} unpacked bytes do not fit {} points of {} bytes", unpacked, count,
                                  header.point_bytes));
  std::vector<std::byte> plain;
  if (unpacked / kLzfMostPerByte <= packed) plain.resize(unpacked);
  if (plain.size() != unpacked || !lzf_unpack(data.subspan(header.bytes + 8, packed), plain))
    return byte_error(name, header.bytes + 8, "the compressed data are corrupt; copy the file again");
  geometry.vertices.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    add_point(geometry, columns, [&](const PcdField& field) {
      const std::size_t stride = static_cast<std::size_t>(field.size * field.count);
      return read_number(plain.data() + field.offset * count + i * stride, field.type, false);
    });
  return success();
}

}  // namespace

Result<Geometry> parse_pcd(std::span<const std::byte> data, std::string_view name) {
  const Result<PcdHeader> header = read_header(data, name);
  if (!header) return header.error();
  Columns columns;
  if (const Outcome found = find_columns(*header, name, columns); !found) return found.error();
  Geometry geometry;
  Outcome read = success();
  if (header->data == "ascii") {
    read = read_ascii(data, *header, columns, name, geometry);
  } else if (header->data == "binary") {
    read = read_binary(data, *header, columns, name, geometry);
  } else if (header->data == "binary_compressed") {
    read = read_compressed(data, *header, columns, name, geometry);
  } else {
    read = line_error(name, header->lines, "DATA must be ascii, binary or binary_compressed");
  }
  if (!read) return read.error();
  return finish_geometry(std::move(geometry), name);
}

}  // namespace pliant

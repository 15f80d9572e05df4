// OFF in ascii, with the prefixes ST (texture coordinates), C (colours) and N (normals).
#include <array>

#include "drivers/geometry_files/finish.hpp"
#include "drivers/geometry_files/numbers.hpp"
#include "drivers/geometry_files/parsers.hpp"

namespace pliant {

namespace {

/// Lines with something on them, comments taken away.
bool next_content(TextCursor& cursor, std::string_view& line) {
  std::string_view word;
  while (cursor.next_line(line)) {
    line = line.substr(0, line.find('#'));
    std::string_view look = line;
    if (take_word(look, word)) return true;
  }
  return false;
}

bool read_numbers(std::string_view& line, std::span<double> numbers) {
  std::string_view word;
  for (double& number : numbers)
    if (!take_word(line, word) || !to_number(word, number)) return false;
  return true;
}

struct OffHeader {
  bool normals = false;
  std::int64_t vertices = 0, faces = 0;
};

Result<OffHeader> read_header(TextCursor& cursor, std::string_view name) {
  OffHeader header;
  std::string_view line, word;
  if (!next_content(cursor, line)) return file_error(name, "is empty");
  std::string_view rest = line;
  take_word(rest, word);
  if (word.ends_with("OFF")) {
    std::string_view prefix = word.substr(0, word.size() - 3);
    if (prefix.starts_with("ST")) prefix.remove_prefix(2);
    if (prefix.starts_with('C')) prefix.remove_prefix(1);
    header.normals = prefix.starts_with('N');
    if (header.normals) prefix.remove_prefix(1);
    if (!prefix.empty())
      return line_error(name, cursor.line(),
                        fmt::format("'{}' files cannot be read, only OFF with ST, C and N", shown(word)));
    line = rest;
    if (take_word(rest, word) && word == "BINARY")
      return line_error(name, cursor.line(), "binary OFF files cannot be read; save it as ascii or as PLY");
    std::string_view look = line;
    if (!take_word(look, word) && !next_content(cursor, line))
      return line_error(name, cursor.line(), "the file ends before its counts; is it cut short?");
  }
  if (!take_word(line, word) || !to_integer(word, header.vertices) || header.vertices < 0 ||
      !take_word(line, word) || !to_integer(word, header.faces) || header.faces < 0)
    return line_error(name, cursor.line(), "the numbers of vertices and faces are wanted here");
  return header;
}

}  // namespace

Result<Geometry> parse_off(std::span<const std::byte> data, std::string_view name) {
  TextCursor cursor(data);
  const Result<OffHeader> header = read_header(cursor, name);
  if (!header) return header.error();
  // A vertex takes six bytes at least ("0 0 0\n"), a face two ("0\n"); the last needs no line end.
  const auto room = static_cast<std::int64_t>(cursor.remaining() + 1);
  if (header->vertices > room / 6 || header->faces > (room - 6 * header->vertices) / 2)
    return line_error(
        name, cursor.line(),
        fmt::format("{} vertices and {} faces are more than the file has room for; is it cut short?",
                    header->vertices, header->faces));

  Geometry geometry;
  geometry.vertices.reserve(static_cast<std::size_t>(header->vertices));
  std::string_view line, word;
  for (std::int64_t i = 0; i < header->vertices; ++i) {
    if (!next_content(cursor, line))
      return line_error(
          name, cursor.line(),
          fmt::format("the file ends after {} of {} vertices; is it cut short?", i, header->vertices));
    std::array<double, 6> numbers{};
    const std::size_t wanted = header->normals ? 6 : 3;
    if (!read_numbers(line, std::span(numbers).first(wanted)))
      return line_error(name, cursor.line(), fmt::format("a vertex needs {} numbers", wanted));
    geometry.vertices.push_back({to_float(numbers[0]), to_float(numbers[1]), to_float(numbers[2])});
    if (header->normals)
      geometry.normals.push_back({to_float(numbers[3]), to_float(numbers[4]), to_float(numbers[5])});
  }
  std::vector<std::uint32_t> corners;
  for (std::int64_t i = 0; i < header->faces; ++i) {
    if (!next_content(cursor, line))
      return line_error(
          name, cursor.line(),
          fmt::format("the file ends after {} of {} faces; is it cut short?", i, header->faces));
    std::int64_t count = 0;
    if (!take_word(line, word) || !to_integer(word, count) || count < 0)
      return line_error(name, cursor.line(), "a face begins with its number of vertices");
    corners.clear();
    for (std::int64_t k = 0; k < count; ++k) {
      std::int64_t corner = 0;
      if (!take_word(line, word) || !to_integer(word, corner))
        return line_error(name, cursor.line(), fmt::format("the face names {} of its {} vertices", k, count));
      if (corner < 0 || corner >= header->vertices)
        return line_error(
            name, cursor.line(),
            fmt::format("the face names vertex {}; they run from 0 to {}", corner, header->vertices - 1));
      corners.push_back(static_cast<std::uint32_t>(corner));
    }
    add_polygon(geometry, corners);
  }
  return finish_geometry(std::move(geometry), name);
}

}  // namespace pliant

// STL, ascii and binary.
#include <algorithm>
#include <array>
#include <bit>
#include <unordered_map>

#include "drivers/geometry_files/finish.hpp"
#include "drivers/geometry_files/numbers.hpp"
#include "drivers/geometry_files/parsers.hpp"

namespace pliant {

namespace {

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;

/// Makes one vertex of corners with the same coordinates.
class Welder {
 public:
  explicit Welder(Geometry& geometry) : geometry_(geometry) {}

  std::uint32_t add(Point3f p) {
    p = {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};  // -0 becomes 0
    const std::array<std::uint32_t, 3> key = {std::bit_cast<std::uint32_t>(p.x),
                                              std::bit_cast<std::uint32_t>(p.y),
                                              std::bit_cast<std::uint32_t>(p.z)};
    const auto [place, is_new] =
        index_.try_emplace(key, static_cast<std::uint32_t>(geometry_.vertices.size()));
    if (is_new) geometry_.vertices.push_back(p);
    return place->second;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<std::uint32_t, 3>& key) const {
      std::uint64_t hash = 0x9e3779b97f4a7c15U;
      for (const std::uint32_t part : key) {
        hash = (hash ^ part) * 0xff51afd7ed558ccdU;
        hash ^= hash >> 32;
      }
      return static_cast<std::size_t>(hash);
    }
  };
  Geometry& geometry_;
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, Hash> index_;
};

bool same_word(std::string_view word, std::string_view lower) {
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  });
}

Result<Geometry> parse_binary(std::span<const std::byte> data, std::string_view name) {
  if (data.size() < kHeaderBytes)
    return file_error(name, "is too short for a binary STL file; is it cut short?");
  const auto count = static_cast<std::uint64_t>(read_number(data.data() + 80, NumberType::uint32, false));
  const std::uint64_t room = (data.size() - kHeaderBytes) / kFacetBytes;
  if (count > room)
    return byte_error(
        name, 80,
        fmt::format("the header says {} triangles, but the file has room for {} (or it is no STL file); "
                    "is it cut short?",
                    count, room));
  Geometry geometry;
  Welder welder(geometry);
  geometry.triangles.reserve(static_cast<std::size_t>(count));
  for (std::uint64_t i = 0; i < count; ++i) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::byte* at = data.data() + kHeaderBytes + i * kFacetBytes + 12 + 12 * k;
      const auto coordinate = [&](std::size_t axis) {
        return static_cast<float>(read_number(at + 4 * axis, NumberType::float32, false));
      };
      corners[k] = welder.add({coordinate(0), coordinate(1), coordinate(2)});
    }
    geometry.triangles.push_back(corners);
  }
  return finish_geometry(std::move(geometry), name);
}

Result<Geometry> parse_ascii(std::span<const std::byte> data, std::string_view name) {
  Geometry geometry;
  Welder welder(geometry);
  TextCursor cursor(data);
  std::string_view line, word;
  std::array<std::uint32_t, 3> corners{};
  std::size_t corner = 0;
  bool ended = false;
  while (cursor.next_line(line)) {
    if (!take_word(line, word)) continue;
    if (same_word(word, "vertex")) {
      std::array<double, 3> xyz{};
      for (double& value : xyz)
        if (!take_word(line, word) || !to_number(word, value))
          return line_error(name, cursor.line(), "a vertex needs three numbers");
      if (corner == 3) return line_error(name, cursor.line(), "a facet with more than three vertices");
      corners[corner++] = welder.add({to_float(xyz[0]), to_float(xyz[1]), to_float(xyz[2])});
    } else if (same_word(word, "endfacet")) {
      if (corner != 3) return line_error(name, cursor.line(), "a facet with fewer than three vertices");
      geometry.triangles.push_back(corners);
      corner = 0;
    } else if (same_word(word, "endsolid")) {
      ended = true;
    } else if (!same_word(word, "facet") && !same_word(word, "outer") && !same_word(word, "endloop") &&
               !same_word(word, "solid")) {
      return line_error(name, cursor.line(), fmt::format("unknown word '{}'", shown(word)));
    }
  }
  if (corner != 0 || !ended)
    return line_error(name, cursor.line(), "the file ends without 'endsolid'; is it cut short?");
  return finish_geometry(std::move(geometry), name);
}

/// Binary files may begin with "solid" too: ascii has a facet, or its end, in the next lines.
bool looks_ascii(std::span<const std::byte> data) {
  TextCursor cursor(data.subspan(0, std::min<std::size_t>(data.size(), 4096)));
  std::string_view line, word;
  if (!cursor.next_line(line) || !take_word(line, word) || !same_word(word, "solid")) return false;
  while (cursor.next_line(line))
    if (take_word(line, word)) return same_word(word, "facet") || same_word(word, "endsolid");
  return false;
}

}  // namespace

Result<Geometry> parse_stl(std::span<const std::byte> data, std::string_view name) {
  return looks_ascii(data) ? parse_ascii(data, name) : parse_binary(data, name);
}

}  // namespace pliant

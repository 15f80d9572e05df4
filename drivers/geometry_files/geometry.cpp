#include "drivers/geometry_files/geometry.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <memory>
#include <system_error>

#include "drivers/geometry_files/finish.hpp"
#include "drivers/geometry_files/numbers.hpp"
#include "drivers/geometry_files/parsers.hpp"

namespace pliant {

namespace {

bool finite(const Point3f& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

std::string_view text_of(std::span<const std::byte> data) {
  return {static_cast<const char*>(static_cast<const void*>(data.data())), data.size()};
}

enum class Format { unknown, ply, obj, stl, off, pcd };

bool binary_stl_fits(std::span<const std::byte> data) {
  if (data.size() < 84) return false;
  const auto triangles = static_cast<std::uint64_t>(read_number(data.data() + 80, NumberType::uint32, false));
  return data.size() == 84 + 50 * triangles;
}

/// By the first word that is no comment.
Format format_by_text(std::string_view text) {
  TextCursor cursor(text.substr(0, 65536));
  std::string_view line, word;
  while (cursor.next_line(line)) {
    if (!take_word(line, word)) continue;
    if (word == "#") {
      if (take_word(line, word) && word == ".PCD") return Format::pcd;
      continue;
    }
    if (word.starts_with('#')) continue;
    if (word == "ply") return Format::ply;
    if (word.ends_with("OFF") && word.size() <= 8) return Format::off;
    if (word == "VERSION" || word == "FIELDS" || word == "COLUMNS") return Format::pcd;
    for (const std::string_view key :
         {"v", "vn", "vt", "vp", "f", "o", "g", "s", "l", "p", "mtllib", "usemtl", "usemap"})
      if (word == key) return Format::obj;
    return Format::unknown;
  }
  return Format::unknown;
}

Format format_by_extension(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return Format::unknown;
  std::string extension(name.substr(dot + 1));
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (extension == "ply") return Format::ply;
  if (extension == "obj") return Format::obj;
  if (extension == "stl") return Format::stl;
  if (extension == "off") return Format::off;
  if (extension == "pcd") return Format::pcd;
  return Format::unknown;
}

Format format_of(std::span<const std::byte> data, std::string_view name) {
  if (binary_stl_fits(data)) return Format::stl;
  const std::string_view text = text_of(data);
  const Format by_text = format_by_text(text);
  if (by_text != Format::unknown) return by_text;
  if (text.starts_with("solid") || text.starts_with("SOLID")) return Format::stl;
  return format_by_extension(name);
}

}  // namespace

Result<Geometry> finish_geometry(Geometry geometry, std::string_view name) {
  const std::size_t count = geometry.vertices.size();
  for (const auto& triangle : geometry.triangles)
    for (const std::uint32_t corner : triangle)
      if (corner >= count)
        return file_error(
            name, fmt::format("a face names vertex {} (counted from 0), but there are only {} vertices",
                              corner, count));
  if (geometry.normals.size() != count) geometry.normals.clear();

  constexpr std::uint32_t gone = 0xFFFFFFFFU;
  const auto bad = static_cast<std::size_t>(std::count_if(geometry.vertices.begin(), geometry.vertices.end(),
                                                          [](const Point3f& p) { return !finite(p); }));
  if (bad > 0) {
    std::vector<std::uint32_t> place(count, gone);
    geometry.original_index.reserve(count - bad);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!finite(geometry.vertices[i])) continue;
      place[i] = static_cast<std::uint32_t>(kept);
      geometry.original_index.push_back(static_cast<std::uint32_t>(i));
      geometry.vertices[kept] = geometry.vertices[i];
      if (!geometry.normals.empty()) geometry.normals[kept] = geometry.normals[i];
      ++kept;
    }
    geometry.vertices.resize(kept);
    if (!geometry.normals.empty()) geometry.normals.resize(kept);
    std::erase_if(geometry.triangles, [&](std::array<std::uint32_t, 3>& triangle) {
      for (std::uint32_t& corner : triangle) corner = place[corner];
      return triangle[0] == gone || triangle[1] == gone || triangle[2] == gone;
    });
    geometry.dropped = bad;
  }
  for (Point3f& normal : geometry.normals)
    if (!finite(normal)) normal = Point3f();
  if (geometry.vertices.empty())
    return file_error(name, bad > 0 ? "none of its points has finite coordinates" : "holds no points");
  return geometry;
}

Result<Geometry> parse_geometry(std::span<const std::byte> data, std::string_view name) {
  const std::string_view text = text_of(data);
  if (data.empty()) return file_error(name, "is empty");
  if (text.starts_with("\x1f\x8b"))
    return file_error(name, "is compressed with gzip; unpack it first (gunzip)");
  if (text.starts_with("PK\x03\x04")) return file_error(name, "is a zip archive; unpack it first");
  if (text.starts_with("PLIANTM\n"))
    return file_error(name, "is a model file already; a mesh or a cloud is wanted here");
  if (text.starts_with("\x89PNG"))
    return file_error(name, "is a picture; a mesh or a cloud is wanted here (PLY, OBJ, STL, OFF, PCD)");
  switch (format_of(data, name)) {
    case Format::ply:
      return parse_ply(data, name);
    case Format::obj:
      return parse_obj(data, name);
    case Format::stl:
      return parse_stl(data, name);
    case Format::off:
      return parse_off(data, name);
    case Format::pcd:
      return parse_pcd(data, name);
    case Format::unknown:
      break;
  }
  return file_error(name, "is of an unknown format; PLY, OBJ, STL, OFF and PCD can be read");
}

Result<Geometry> read_geometry(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code fault;
  if (std::filesystem::is_directory(path, fault)) return file_error(name, "is a folder; name a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "rb"), &std::fclose);
  if (!file) return file_error(name, "cannot be read: " + std::generic_category().message(errno));

  constexpr std::size_t block = std::size_t{1} << 20;
  std::vector<std::byte> data;
  const std::uintmax_t declared = std::filesystem::file_size(path, fault);
  if (!fault && declared <= kMaxGeometryBytes) data.reserve(static_cast<std::size_t>(declared) + block);
  for (std::size_t got = block; got > 0;) {
    const std::size_t before = data.size();
    data.resize(before + block);
    got = std::fread(data.data() + before, 1, block, file.get());
    data.resize(before + got);
    if (data.size() > kMaxGeometryBytes)
      return file_error(name, fmt::format("is larger than {} MB; reduce it first", kMaxGeometryBytes >> 20));
  }
  if (std::ferror(file.get()) != 0)
    return file_error(name, "cannot be read: " + std::generic_category().message(errno));
  return parse_geometry(data, name);
}

}  // namespace pliant

#include <fmt/format.h>

#include "drivers/geometry_files/atomic_file.hpp"
#include "drivers/geometry_files/geometry.hpp"
#include "drivers/geometry_files/little_endian.hpp"

namespace pliant {

namespace {

std::byte* put_point(std::byte* at, const Point3f& p) {
  return put_float(put_float(put_float(at, p.x), p.y), p.z);
}

}  // namespace

Outcome write_ply(const std::filesystem::path& path, const Geometry& geometry) {
  const bool normals = !geometry.normals.empty() && geometry.normals.size() == geometry.vertices.size();
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n",
      geometry.vertices.size());
  if (normals) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!geometry.triangles.empty())
    header +=
        fmt::format("element face {}\nproperty list uchar int vertex_indices\n", geometry.triangles.size());
  header += "end_header\n";

  std::vector<std::byte> bytes(header.size() + geometry.vertices.size() * (normals ? 24 : 12) +
                               geometry.triangles.size() * 13);
  std::byte* at = bytes.data();
  for (const char c : header) at = put_u8(at, static_cast<std::uint8_t>(c));
  for (std::size_t i = 0; i < geometry.vertices.size(); ++i) {
    at = put_point(at, geometry.vertices[i]);
    if (normals) at = put_point(at, geometry.normals[i]);
  }
  for (const auto& triangle : geometry.triangles) {
    at = put_u8(at, 3);
    for (const std::uint32_t corner : triangle) at = put_u32(at, corner);
  }
  return write_whole_file(path.c_str(), bytes, false);
}

}  // namespace pliant

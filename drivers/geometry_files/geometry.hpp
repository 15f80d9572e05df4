// Clouds and triangle meshes from files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/geometry/rigid_transform.hpp"
#include "drivers/common/result.hpp"

namespace pliant {

/// A cloud (no triangles) or a mesh, in the file's unit and frame. Every vertex is finite and every index of
/// a triangle is valid.
struct Geometry {
  std::vector<Point3f> vertices;
  std::vector<Point3f> normals;  ///< empty, or one a vertex as the file has it (not made unit length)
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Which vertex of the file vertex i is. Empty when all of the file's are here, in its order.
  std::vector<std::uint32_t> original_index;
  std::size_t dropped = 0;  ///< vertices of the file left out because a coordinate is no finite number
};

/// Reads a PLY, OBJ, STL, OFF or PCD file; the content decides which, the extension where the content leaves
/// it open. Files over kMaxGeometryBytes are refused.
[[nodiscard]] Result<Geometry> read_geometry(const std::filesystem::path& path);

/// Writes a binary little-endian PLY: vertices, normals when there are any, triangles when there are any.
[[nodiscard]] Outcome write_ply(const std::filesystem::path& path, const Geometry& geometry);

inline constexpr std::size_t kMaxGeometryBytes = std::size_t{1} << 30;

}  // namespace pliant

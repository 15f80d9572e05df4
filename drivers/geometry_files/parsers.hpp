// One parser a format, from memory. `name` stands in front of error messages. None trusts a declared count:
// storage is only reserved for what the bytes at hand can hold.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "drivers/common/result.hpp"
#include "drivers/geometry_files/geometry.hpp"

namespace pliant {

/// PLY 1.0, ascii and binary of either byte order; polygons and strips become triangles, other elements and
/// properties are skipped.
[[nodiscard]] Result<Geometry> parse_ply(std::span<const std::byte> data, std::string_view name);
/// Wavefront OBJ: v, vn, f; polygons become triangles; everything else is skipped.
[[nodiscard]] Result<Geometry> parse_obj(std::span<const std::byte> data, std::string_view name);
/// STL, ascii or binary; equal corners become one vertex.
[[nodiscard]] Result<Geometry> parse_stl(std::span<const std::byte> data, std::string_view name);
/// OFF with the prefixes ST, C and N, ascii.
[[nodiscard]] Result<Geometry> parse_off(std::span<const std::byte> data, std::string_view name);
/// PCD 0.x, ascii, binary and binary_compressed. The viewpoint is not applied.
[[nodiscard]] Result<Geometry> parse_pcd(std::span<const std::byte> data, std::string_view name);
/// Chooses one of the above by content, then by the extension of `name`.
[[nodiscard]] Result<Geometry> parse_geometry(std::span<const std::byte> data, std::string_view name);

}  // namespace pliant

// The last step of every parser.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "drivers/common/result.hpp"
#include "drivers/geometry_files/geometry.hpp"

namespace pliant {

/// "NAME: line N: what"
[[nodiscard]] inline Error line_error(std::string_view name, std::size_t line, std::string_view what) {
  return {ErrorKind::bad_input, fmt::format("{}: line {}: {}", name, line, what)};
}
/// "NAME: byte N: what"
[[nodiscard]] inline Error byte_error(std::string_view name, std::size_t byte, std::string_view what) {
  return {ErrorKind::bad_input, fmt::format("{}: byte {}: {}", name, byte, what)};
}
/// "NAME: what"
[[nodiscard]] inline Error file_error(std::string_view name, std::string_view what) {
  return {ErrorKind::bad_input, fmt::format("{}: {}", name, what)};
}

/// Drops vertices that are not finite together with their triangles, checks every index, forgets normals that
/// are not one a vertex. An error when no vertex is left.
[[nodiscard]] Result<Geometry> finish_geometry(Geometry geometry, std::string_view name);

/// Adds polygon `corners` as a fan. Fewer than three corners add nothing.
template <typename Corners>
void add_polygon(Geometry& geometry, const Corners& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i)
    geometry.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace pliant

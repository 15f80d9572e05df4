// Tables that are stored row after row: pictures, lattices, matrices.
#pragma once

#include <cstddef>

namespace pliant {

/// Place of an element; neither row nor column may be negative.
[[nodiscard]] constexpr std::size_t row_major(int row, int columns, int column) noexcept {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
}

/// Elements of a table; neither extent may be negative.
[[nodiscard]] constexpr std::size_t table_size(int columns, int rows) noexcept {
  return row_major(rows, columns, 0);
}

}  // namespace pliant

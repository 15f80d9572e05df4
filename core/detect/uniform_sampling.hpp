// Uniform downsampling of a cloud: the paper's choice of keypoints (section 3.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/geometry/rigid_transform.hpp"
#include "core/memory/workspace.hpp"

namespace pliant {

/// Keeps one point of each cell of a cubic lattice: the one nearest to the cell's centre, of equals the
/// first.
class UniformSampling {
 public:
  /// Takes the memory for clouds of up to `capacity` points.
  void lay_out(Workspace& workspace, std::size_t capacity) noexcept;

  /// Writes the indices of the kept points, ascending, to `kept` and returns how many there are; those that
  /// do not fit into `kept` are counted but not written. Non-finite points and those beyond the capacity are
  /// left out. `leaf`: the cells' edge, metres, > 0.
  [[nodiscard]] std::size_t sample(std::span<const Point3f> points, double leaf,
                                   std::span<std::uint32_t> kept) noexcept;

 private:
  struct Cell {
    std::int32_t x, y, z;
    std::uint32_t best;    // index + 1 of the kept point, 0: the slot is free
    float squared_offset;  // of the kept point from the cell's centre
  };
  std::span<Cell> cells_;
  std::span<std::uint32_t> used_;  // slots in use, in order of first use
};

}  // namespace pliant

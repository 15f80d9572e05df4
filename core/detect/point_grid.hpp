// A flat index of points for radius and nearest-neighbour queries: uniform cells, hashed into buckets.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/geometry/rigid_transform.hpp"
#include "core/memory/workspace.hpp"

namespace pliant {

/// Points sorted by the bucket of their cell. Cells that follow each other along x stand in buckets that
/// follow each other, so that a row of cells is one run of points. Same input, same order: deterministic.
/// Non-finite points are left out. Any extent is fine: far outliers cost nothing.
class PointGrid {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Takes the memory for up to `capacity` points (about 24 to 32 bytes a point).
  void lay_out(Workspace& workspace, std::size_t capacity) noexcept;

  /// Indexes `points` (metres, at most the capacity) in cells of edge `cell` (metres, > 0). False when there
  /// are too many points or the cell is not positive. Queries are fastest with radii of one to three cells.
  [[nodiscard]] bool build(std::span<const Point3f> points, double cell) noexcept;

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  [[nodiscard]] double cell() const noexcept { return cell_; }

  /// Calls visit(index, position, squared distance) for the points within `radius` of `p`, in the grid's
  /// order, until `most` were visited. Returns how many. Looks at no more than 16 × `most` candidates, so
  /// that heaps of points elsewhere in a bucket cannot take unbounded time. All of a cell's row count when
  /// radius is large: keep radius below 16 cells.
  template <typename Visit>
  std::size_t visit_within(const Point3f& p, float radius, std::size_t most, Visit&& visit) const noexcept;

  /// As visit_within(), but writes offsets from `p` (metres), squared distances and indices to arrays that
  /// have room for most + 1 entries each. Points of other rows that share buckets are passed over without a
  /// jump.
  struct Gathered {
    float *x, *y, *z, *square;
    std::uint32_t* index;
  };
  [[nodiscard]] std::size_t gather_within(const Point3f& p, float radius, std::size_t most,
                                          const Gathered& out) const noexcept;

  /// The nearest point within `radius` of `p` for which accept(index) holds, or kNone; of equals the lowest
  /// index.
  template <typename Accept>
  [[nodiscard]] std::uint32_t nearest_if(const Point3f& p, float radius, float& squared_distance,
                                         Accept&& accept) const noexcept;
  [[nodiscard]] std::uint32_t nearest(const Point3f& p, float radius,
                                      float& squared_distance) const noexcept {
    return nearest_if(p, radius, squared_distance, [](std::uint32_t) { return true; });
  }

 private:
  struct Entry {
    Point3f position;
    std::uint32_t index;
  };
  [[nodiscard]] std::int32_t cell_of(float x) const noexcept {
    const double c = static_cast<double>(x) * inverse_cell_;
    if (!(c > -1e9)) return -1000000000;  // also for what is not a number
    if (c > 1e9) return 1000000000;
    const auto towards_zero = static_cast<std::int32_t>(c);
    return towards_zero - (c < towards_zero ? 1 : 0);
  }
  /// How far `x` (metres) is from cells of number `cell`, less a little, so that rounding leaves no point
  /// out.
  [[nodiscard]] double gap_to(std::int32_t cell, float x) const noexcept {
    const double at = static_cast<double>(x) * inverse_cell_ - cell;
    const double gap = at < 0 ? -at : at > 1 ? at - 1 : 0;
    return gap > 1e-5 ? (gap - 1e-5) * cell_ : 0;
  }
  static std::uint32_t row_of(std::int32_t y, std::int32_t z) noexcept {
    return static_cast<std::uint32_t>(y) * 2654435761U + static_cast<std::uint32_t>(z) * 2246822519U;
  }
  /// Calls look(entry) for each entry of the row's cells x0..x1 until it returns false.
  template <typename Look>
  bool scan_row(std::int32_t x0, std::int32_t x1, std::int32_t y, std::int32_t z, Look&& look) const noexcept;

  std::span<Entry> entries_;
  std::span<std::uint32_t> rows_;    // of each entry: row_of its cell, to tell rows apart that share buckets
  std::span<std::uint32_t> starts_;  // of each bucket, and the end
  std::span<std::uint32_t> bucket_of_;
  std::size_t count_ = 0;
  std::uint32_t mask_ = 0;
  double cell_ = 1;
  double inverse_cell_ = 1;
};

template <typename Look>
bool PointGrid::scan_row(std::int32_t x0, std::int32_t x1, std::int32_t y, std::int32_t z,
                         Look&& look) const noexcept {
  const std::uint32_t row = row_of(y, z);
  std::uint32_t bucket = (row + static_cast<std::uint32_t>(x0)) & mask_;
  std::uint32_t left = static_cast<std::uint32_t>(x1 - x0) + 1;
  if (left > mask_ + 1) left = mask_ + 1;
  while (left > 0) {
    const std::uint32_t run = left < mask_ + 1 - bucket ? left : mask_ + 1 - bucket;
    for (std::uint32_t e = starts_[bucket]; e < starts_[bucket + run]; ++e)
      if (rows_[e] == row && !look(entries_[e])) return false;
    left -= run;
    bucket = 0;
  }
  return true;
}

template <typename Visit>
std::size_t PointGrid::visit_within(const Point3f& p, float radius, std::size_t most,
                                    Visit&& visit) const noexcept {
  const float limit = radius * radius;
  std::size_t visited = 0;
  std::size_t candidates = 16 * most;
  const auto look = [&](const Entry& e) {
    const float x = e.position.x - p.x, y = e.position.y - p.y, z = e.position.z - p.z;
    const float square = x * x + y * y + z * z;
    if (square <= limit) {
      visit(e.index, e.position, square);
      if (++visited == most) return false;
    }
    return --candidates > 0;
  };
  const std::int32_t x0 = cell_of(p.x - radius), x1 = cell_of(p.x + radius);
  const std::int32_t y0 = cell_of(p.y - radius), y1 = cell_of(p.y + radius);
  const std::int32_t z0 = cell_of(p.z - radius), z1 = cell_of(p.z + radius);
  if (most == 0 || count_ == 0) return 0;
  for (std::int32_t z = z0; z <= z1; ++z)
    for (std::int32_t y = y0; y <= y1; ++y)
      if (!scan_row(x0, x1, y, z, look)) return visited;
  return visited;
}

template <typename Accept>
std::uint32_t PointGrid::nearest_if(const Point3f& p, float radius, float& squared_distance,
                                    Accept&& accept) const noexcept {
  float best = radius * radius;
  std::uint32_t found = kNone;
  const auto look = [&](const Entry& e) {
    const float x = e.position.x - p.x, y = e.position.y - p.y, z = e.position.z - p.z;
    const float square = x * x + y * y + z * z;
    if (square < best || (square == best && e.index < found)) {
      if (accept(e.index)) {
        best = square;
        found = e.index;
      }
    }
    return true;
  };
  if (count_ == 0) return kNone;
  // The own row first: what it yields narrows the others.
  const std::int32_t yc = cell_of(p.y), zc = cell_of(p.z);
  scan_row(cell_of(p.x - radius), cell_of(p.x + radius), yc, zc, look);
  const float reach = std::sqrt(best);
  const std::int32_t x0 = cell_of(p.x - reach), x1 = cell_of(p.x + reach);
  const std::int32_t y0 = cell_of(p.y - reach), y1 = cell_of(p.y + reach);
  const std::int32_t z0 = cell_of(p.z - reach), z1 = cell_of(p.z + reach);
  for (std::int32_t z = z0; z <= z1; ++z) {
    const double across_z = gap_to(z, p.z);
    for (std::int32_t y = y0; y <= y1; ++y) {
      if (y == yc && z == zc) continue;
      const double across_y = gap_to(y, p.y);
      if (across_y * across_y + across_z * across_z <= static_cast<double>(best))
        scan_row(x0, x1, y, z, look);
    }
  }
  squared_distance = best;
  return found;
}

}  // namespace pliant

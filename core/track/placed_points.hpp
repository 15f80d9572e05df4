// Points under one pose, many at a time: loops over arrays, of which compilers make vectors.
#pragma once

#include <array>
#include <cstdint>

#include "core/track/associate.hpp"
#include "core/track/contour.hpp"
#include "core/track/model_tables.hpp"

namespace pliant {

/// How a surface stands to the line of sight.
enum class Side : std::int32_t {
  away,   ///< turned away, or seen too flat
  rim,    ///< on the outline: on_rim()
  facing  ///< faces_camera() within 75°
};

/// The point in the camera frame, 1/16 mm, its normal in Q14.
[[nodiscard]] inline Side side_of(const IntPoint& point, const IntPoint& normal) noexcept {
  return faces_camera(point, normal, kCos75) ? Side::facing : on_rim(point, normal) ? Side::rim : Side::away;
}

/// Points and normals in arrays, from one of them on.
struct PointColumns {
  const std::int16_t *x, *y, *z, *nx, *ny, *nz;

  /// Of the model or of its patches.
  template <typename Tables>
  PointColumns(const Tables& tables, std::size_t first) noexcept
      : x(&tables.x[first]),
        y(&tables.y[first]),
        z(&tables.z[first]),
        nx(&tables.nx[first]),
        ny(&tables.ny[first]),
        nz(&tables.nz[first]) {}
};

/// Some points in the camera frame: the values of FixedPose, one array a coordinate.
struct PlacedPoints {
  static constexpr std::size_t kMost = 64;

  std::array<std::int32_t, kMost> x, y, z, nx, ny, nz;
  std::array<Side, kMost> side;

  /// The first `count` of the columns, at most kMost; whole blocks (PatchPoints) are the quickest. Sides hold
  /// up to 32 m from the camera along each axis; nothing beyond 8 m of depth is looked at.
  void place(const PointColumns& from, std::size_t count, const FixedPose& pose) noexcept;
  /// Point k as another pose has it.
  void put(std::size_t k, const IntPoint& point, const IntPoint& normal) noexcept {
    x[k] = point.x;
    y[k] = point.y;
    z[k] = point.z;
    nx[k] = normal.x;
    ny[k] = normal.y;
    nz[k] = normal.z;
    side[k] = side_of(point, normal);
  }
  [[nodiscard]] IntPoint point(std::size_t k) const noexcept { return {x[k], y[k], z[k]}; }
  [[nodiscard]] IntPoint normal(std::size_t k) const noexcept { return {nx[k], ny[k], nz[k]}; }
};

}  // namespace pliant

// The pinhole camera. Axes: x right, y down, z forward.
#pragma once

namespace pliant {

/// u = fx * x / z + cx, v = fy * y / z + cy; pixel centres at whole numbers. No lens distortion.
struct Intrinsics {
  int width = 0;              ///< pixels
  int height = 0;             ///< pixels
  double fx = 0, fy = 0;      ///< pixels
  double cx = 0, cy = 0;      ///< pixels
  double depth_scale = 1000;  ///< raw units per metre; 1000 for millimetres
};

/// How far aside a pixel may look, by how far ahead: 63 degrees from the axis. Rays and projected points fit
/// 16 and 32 bits up to it.
inline constexpr double kMostSlope = 2;

/// What is wrong with the intrinsics in words, or null: sizes within limits, focal lengths and depth scale
/// positive and finite, principal point finite, no pixel beyond kMostSlope.
[[nodiscard]] const char* intrinsics_fault(const Intrinsics& camera) noexcept;

}  // namespace pliant

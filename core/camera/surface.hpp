// The observed surface in a window of the depth frame: cleaned and smoothed depth, vertices and normals on
// demand.
#pragma once

#include <cstdint>
#include <span>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// Pixels [u0, u1) × [v0, v1).
struct Window {
  int u0 = 0, v0 = 0, u1 = 0, v1 = 0;

  [[nodiscard]] bool empty() const noexcept { return u0 >= u1 || v0 >= v1; }
  [[nodiscard]] bool contains(int u, int v) const noexcept { return u >= u0 && u < u1 && v >= v0 && v < v1; }
};

/// A point or vector in the camera frame, 1/16 mm.
struct IntPoint {
  std::int32_t x = 0, y = 0, z = 0;
};

/// Units of length in the integer path.
inline constexpr int kUnitsPerMillimetre = 16;         ///< of points
inline constexpr double kUnitsPerMetre = 16000.0;      ///< of points
inline constexpr double kDepthUnitsPerMetre = 8000.0;  ///< of depth pictures

/// Owns two depth pictures of the camera's size, 16 bits a pixel at 1/8 mm, 0 = no reading. Only the window
/// of the last build() holds data; everything outside it reads as "no reading".
class Surface {
 public:
  /// Takes what a camera of this size needs.
  void lay_out(Workspace& workspace, const Intrinsics& camera) noexcept;
  /// Fills the tables; after lay_out() on a real workspace.
  void start(const Intrinsics& camera, const SensorDescription& sensor) noexcept;

  /// Cleans and smooths `window` of `frame` (clipped to the picture):
  /// readings outside the sensor's range go; a reading with fewer than kMinSupport of its eight neighbours at
  /// its own depth is a flying pixel and goes; the rest becomes the mean of those of its 3×3 neighbourhood
  /// that lie within the discontinuity limit.
  void build(const DepthFrame& frame, Window window) noexcept;

  static constexpr int kMinSupport = 3;

  [[nodiscard]] const Window& window() const noexcept { return window_; }
  /// Smoothed depth at a pixel of the window, 1/8 mm, 0 = none. No bounds check.
  [[nodiscard]] std::uint16_t depth_at(int u, int v) const noexcept {
    return smooth_[static_cast<std::size_t>(v * width_ + u)];
  }
  /// As depth_at(), 0 outside the window.
  [[nodiscard]] std::uint16_t depth(int u, int v) const noexcept {
    return window_.contains(u, v) ? depth_at(u, v) : 0;
  }
  /// The vertex of a pixel with depth `z8` (1/8 mm); exact to half a unit plus 2^-15 of the depth.
  [[nodiscard]] IntPoint vertex(int u, int v, std::uint16_t z8) const noexcept {
    const std::int32_t z = z8;
    return {(z * ray_x_[static_cast<std::size_t>(u)] + (1 << 12)) >> 13,
            (z * ray_y_[static_cast<std::size_t>(v)] + (1 << 12)) >> 13, z * 2};
  }
  /// Unit normal towards the camera from depth differences `step` pixels to each side (one-sided where the
  /// other side is missing or across a discontinuity). False when there is none.
  [[nodiscard]] bool normal(int u, int v, int step, Normal16& out) const noexcept;
  /// Does the surface at the pixel face along `direction` (unit, Q14) within 60°? Without a normal there: true.
  [[nodiscard]] bool faces(int u, int v, int step, const IntPoint& direction) const noexcept;
  /// The step for normal() that spans about `metres` at depth z8.
  [[nodiscard]] int normal_step(std::uint16_t z8, double metres) const noexcept;

  /// Largest depth difference between neighbouring pixels of one surface, 1/8 mm:
  /// 4 σ of the sensor plus a slope of 75° over one pixel.
  [[nodiscard]] std::uint16_t discontinuity(std::uint16_t z8) const noexcept {
    return discontinuity_[static_cast<std::size_t>(z8 >> kDepthTableShift)];
  }
  /// σ of a reading, 1/16 mm, at least 1.
  [[nodiscard]] std::int32_t sigma(std::int32_t z16) const noexcept {
    const std::int32_t i = z16 >> (kDepthTableShift + 1);
    return sigma_[static_cast<std::size_t>(i < 0 ? 0 : i >= kDepthTableSize ? kDepthTableSize - 1 : i)];
  }
  [[nodiscard]] const Intrinsics& camera() const noexcept { return camera_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

 private:
  static constexpr int kDepthTableShift = 8;  // a table entry spans 32 mm
  static constexpr int kDepthTableSize = 256;

  /// Normal of any length, largest component below 2^14. False when there is none.
  [[nodiscard]] bool raw_normal(int u, int v, int step, IntPoint& out) const noexcept;
  void convert_row(const std::uint16_t* raw, int v) noexcept;
  void clean_row(int v) noexcept;
  void smooth_row(int v) noexcept;

  Intrinsics camera_;
  int width_ = 0, height_ = 0;
  Window window_;
  std::uint32_t scale_ = 0;           // depth units per raw unit, Q16
  std::uint32_t near_ = 0, far_ = 0;  // 1/8 mm
  std::span<std::uint16_t>
      converted_;  // three border-padded stages share two pictures: converted, then smooth
  std::span<std::uint16_t> cleaned_;
  std::span<std::uint16_t> smooth_;
  std::span<std::int16_t> ray_x_, ray_y_;  // (u - cx) / fx, (v - cy) / fy in Q14
  std::span<std::uint16_t> discontinuity_;
  std::span<std::int32_t> sigma_;
};

}  // namespace pliant

// The observed surface in a window of the depth frame: cleaned and smoothed depth, vertices and normals on
// demand. All in integers.
#pragma once

#include <cstdint>
#include <span>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/camera/surface_rows.hpp"
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

/// Exact. Overflow bound: coordinates below 2^29.
[[nodiscard]] constexpr std::int64_t squared_distance(const IntPoint& a, const IntPoint& b) noexcept {
  const std::int64_t x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return x * x + y * y + z * z;
}

/// Units of length in the integer path.
inline constexpr int kUnitsPerMillimetre = 16;         ///< of points
inline constexpr double kUnitsPerMetre = 16000.0;      ///< of points
inline constexpr double kDepthUnitsPerMetre = 8000.0;  ///< of depth pictures

/// A length as pixels times depth: what spans it at depth z8 is span / z8 pixels.
struct PixelSpan {
  std::int32_t span = 0;  ///< pixels · 1/8 mm
};

/// Owns a depth picture of the camera's size, 16 bits a pixel at 1/8 mm, 0 = no reading. Only the window of
/// the last build() holds data; everything outside it reads as "no reading". What a pixel of the window holds
/// does not depend on the window. Normals are kept once they were asked for: a surface is one thread's.
class Surface {
 public:
  /// Takes what a camera of this size needs.
  void lay_out(Workspace& workspace, const Intrinsics& camera) noexcept;
  /// Fills the tables; after lay_out() on a real workspace. Without `filtered`, build() neither cleans nor
  /// smooths.
  void start(const Intrinsics& camera, const SensorDescription& sensor, Kernels kernels = Kernels::automatic,
             bool filtered = true) noexcept;

  /// Cleans and smooths `window` of `frame` (clipped to the picture):
  /// readings outside the sensor's range go; a reading with fewer than kMinSupport of its eight neighbours at
  /// its own depth is a flying pixel and goes; the rest becomes the mean of those of its 3×3 neighbourhood
  /// that lie within the discontinuity limit.
  void build(const DepthFrame& frame, Window window) noexcept;

  [[nodiscard]] const Window& window() const noexcept { return window_; }
  /// Smoothed depth at a pixel of the picture, 1/8 mm, 0 = none. No bounds check.
  [[nodiscard]] std::uint16_t depth_at(int u, int v) const noexcept { return *at(u, v); }
  [[nodiscard]] bool inside(int u, int v) const noexcept {
    return static_cast<unsigned>(u) < static_cast<unsigned>(width_) &&
           static_cast<unsigned>(v) < static_cast<unsigned>(height_);
  }
  /// As depth_at(), 0 outside the picture.
  [[nodiscard]] std::uint16_t depth(int u, int v) const noexcept {
    return inside(u, v) ? depth_at(u, v) : std::uint16_t{0};
  }
  /// The vertex of a pixel with depth `z8` (1/8 mm); exact to half a unit plus 2^-15 of the depth.
  [[nodiscard]] IntPoint vertex(int u, int v, std::uint16_t z8) const noexcept {
    const std::int32_t z = z8;
    return {(z * ray_x_[static_cast<std::size_t>(u)] + (1 << 12)) >> 13,
            (z * ray_y_[static_cast<std::size_t>(v)] + (1 << 12)) >> 13, z * 2};
  }
  /// Unit normal towards the camera from depth differences `step` pixels (1 … kMostStep) to each side
  /// (one-sided where the other side is missing or across a discontinuity). False when there is none. The
  /// pixel lies in the picture.
  [[nodiscard]] bool normal(int u, int v, int step, Normal16& out) const noexcept;
  /// Does the surface at the pixel face along `direction` (unit, Q14) within 60°? Without a normal there:
  /// true.
  [[nodiscard]] bool faces(int u, int v, int step, const IntPoint& direction) const noexcept {
    const KeptNormal& n = raw_normal(u, v, step);
    if (n.is_none()) return true;
    // Products below 2^14 · 2^14.1, their sum |n| · cos · 2^14 below 2^30.
    const std::int32_t dot = n.x * direction.x + n.y * direction.y + n.z * direction.z;
    if (dot <= 0) return false;
    const auto square = static_cast<std::uint32_t>(n.x * n.x + n.y * n.y + n.z * n.z);  // below 2^30
    const auto cosine = static_cast<std::uint32_t>(dot >> 13);                          // 2 · |n| · cos
    return cosine * cosine >= square;
  }
  /// The step for normal() that spans about that length at depth z8.
  [[nodiscard]] static int normal_step(std::uint16_t z8, PixelSpan length) noexcept {
    if (z8 == 0) return 1;
    const std::int32_t step = (length.span + z8 / 2) / z8;
    return step < 1 ? 1 : step > kMostStep ? kMostStep : step;
  }
  [[nodiscard]] PixelSpan pixel_span(double metres) const noexcept;
  static constexpr int kMostStep = 8;

  /// Largest depth difference between neighbouring pixels of one surface, 1/8 mm.
  [[nodiscard]] std::uint16_t discontinuity(std::uint16_t z8) const noexcept { return rule_.limit(z8); }
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
  static constexpr std::size_t kMargin = 16;  // no readings around the picture: normals look without a check
  static constexpr std::size_t kRing = 3;     // rows of the stages before the last
  static_assert(kMargin >= kRowSlack && kMargin >= kMostStep);

  /// A normal of any length, components below 2^14, kept once it was asked for: the same pixels are looked at
  /// again and again in a frame. All zero where there is none.
  struct KeptNormal {
    std::int16_t x = 0, y = 0, z = 0;
    std::uint16_t key = 0;  ///< of the picture and the step that it was taken with

    [[nodiscard]] bool is_none() const noexcept { return (x | y | z) == 0; }
  };
  /// Pictures count in steps of this, so that a key holds a step beside them.
  static constexpr std::uint16_t kKeyOfPicture = 16;
  static_assert(kMostStep < kKeyOfPicture);

  [[nodiscard]] const KeptNormal& raw_normal(int u, int v, int step) const noexcept {
    KeptNormal& kept = normals_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                                static_cast<std::size_t>(u)];
    if (kept.key != picture_key_ + step) kept = take_normal(u, v, step);
    return kept;
  }
  [[nodiscard]] KeptNormal take_normal(int u, int v, int step) const noexcept;
  [[nodiscard]] const std::uint16_t* at(int u, int v) const noexcept {
    return picture_ + static_cast<std::ptrdiff_t>(v) * static_cast<std::ptrdiff_t>(stride_) + u;
  }

  Intrinsics camera_;
  int width_ = 0, height_ = 0;
  std::size_t stride_ = 0;  // pixels from one row of the picture to the next
  Window window_;
  SurfaceRows rows_;
  DepthScale scale_;
  DiscontinuityRule rule_;
  std::int32_t focal_x_ = 0, focal_y_ = 0;  // Q8
  std::span<std::uint16_t> smooth_;         // the picture and its margins
  std::uint16_t* picture_ = nullptr;        // pixel (0, 0) in it
  std::span<KeptNormal> normals_;           // of the picture, row by row: a cache
  std::uint16_t picture_key_ = 0;           // of the last build()
  std::span<std::uint16_t> converted_;      // kRing rows, then one of zeros
  std::span<std::uint16_t> cleaned_;        // kRing rows
  std::span<std::int16_t> ray_x_, ray_y_;   // (u - cx) / fx, (v - cy) / fy in Q14
  std::span<std::int32_t> sigma_;
};

}  // namespace pliant

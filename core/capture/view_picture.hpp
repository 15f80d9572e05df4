// One view of the object as it is fused: depth, and which readings are the object's.
#pragma once

#include <cstdint>
#include <span>

#include "core/camera/surface.hpp"

namespace pliant {

/// Borrowed pictures of a window, rows without gaps.
struct ViewPicture {
  Window window;                   ///< of the camera's picture
  std::span<std::uint16_t> depth;  ///< 1/8 mm, 0 = no reading
  /// 0: not the object's; else how far the surface lies before a point of the pixel's ray, along the
  /// surface's normal, as a share of how far it does along the camera's axis: cosine to the ray times the
  /// ray's length at depth one. Q7 [1, 255].
  std::span<std::uint8_t> facing;

  [[nodiscard]] int width() const noexcept { return window.u1 - window.u0; }
  [[nodiscard]] std::size_t size() const noexcept {
    return window.empty()
               ? 0
               : static_cast<std::size_t>(width()) * static_cast<std::size_t>(window.v1 - window.v0);
  }
  /// The pixel lies in the window.
  [[nodiscard]] std::size_t index(int u, int v) const noexcept {
    return static_cast<std::size_t>(v - window.v0) * static_cast<std::size_t>(width()) +
           static_cast<std::size_t>(u - window.u0);
  }
};

/// Least facing that is fused: 72° from the surface's normal; readings seen flatter are worth little.
inline constexpr std::int32_t kLeastFacingView = 40;

/// Fills the picture's window from the surface. `taken` tells for each 2×2 cell of the camera's picture
/// whether its readings are the object's. Of these, readings within two pixels of where the surface ends are
/// left out: sensors flicker and fly there.
struct CellMask {
  std::span<const std::uint8_t> taken;  ///< non-zero: taken; rows of `width` cells
  int width = 0;
};
void take_picture(const Surface& surface, const CellMask& mask, std::int32_t normal_span,
                  ViewPicture& picture) noexcept;

/// A reading of a view with its normal, camera frame.
struct ViewPoint {
  std::int16_t x = 0, y = 0, z = 0;     ///< 1/16 mm
  std::int16_t nx = 0, ny = 0, nz = 0;  ///< Q14, towards the camera
};
/// Readings farther away are not used: 16-bit coordinates.
inline constexpr double kFarthestView = 2.0;

}  // namespace pliant

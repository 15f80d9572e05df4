// Where the camera sees through a point of the object, the object's edge has moved aside.
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

/// How far and in which steps the picture is searched beside a pixel.
struct AsideReach {
  std::int32_t inward = 0;   ///< how far behind the point a reading may lie, and how far from it, 1/16 mm
  std::int32_t outward = 0;  ///< how far before it, 1/16 mm
  int step = 1;              ///< pixels between looks
  PixelSpan spacing;         ///< over which normals are taken
};

inline constexpr int kLooksAside = 4;  ///< to each side

/// What pulls a point aside: the unit direction (Q14) and the distance (1/16 mm) to the nearest reading of
/// the object, and that one's pixel.
struct Aside {
  IntPoint direction;
  std::int32_t distance = 0;
  std::int32_t match = -1;
};

/// The nearest reading along the four directions of the picture, beside pixel (u, v) where the camera sees
/// through the point `at` with normal `n`, whose surface faces as the point does. False when there is none,
/// or when the pixel lies in the shadow of something nearer and may hide the point. What lies farther than
/// kFarthestReading is not taken, whatever the reach, so that a distance squared stays below 2^26.
[[nodiscard]] bool find_aside(const Surface& surface, const AsideReach& reach, int u, int v,
                              const IntPoint& at, const IntPoint& n, Aside& found) noexcept;

}  // namespace pliant

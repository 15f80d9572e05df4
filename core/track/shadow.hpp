// Where the picture tells nothing because something nearer stands between the sensor's two eyes and the
// object.
#pragma once

#include <algorithm>

#include "core/camera/surface.hpp"

namespace pliant {

/// Does pixel (u, v), which has no reading, lie in the shadow of something that stands more than `nearer`
/// before depth `z` (1/16 mm)? The projector, or a stereo pair's other camera, stands to the right of the
/// camera in the usual sensors: the shadow lies to the left of what throws it, along the row, and holds no
/// reading up to there. `step`: pixels between looks.
[[nodiscard]] inline bool in_shadow(const Surface& surface, int u, int v, std::int32_t z, std::int32_t nearer,
                                    int step) noexcept {
  constexpr int kLooks = 4, kLeastStep = 4;  // together wider than a finger's shadow upon what it touches
  for (int k = 1; k <= kLooks; ++k)
    if (const std::uint16_t z8 = surface.depth(u + k * std::max(step, kLeastStep), v); z8 != 0)
      return z - 2 * z8 > nearer;
  return false;
}

}  // namespace pliant

#include "core/capture/view_picture.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/memory/row_major.hpp"

namespace pliant {

namespace {

constexpr int kRim = 2;  // pixels

/// The surface goes on to all four sides, or what is there lies before it.
bool goes_on(const Surface& surface, int u, int v, std::uint16_t z8) noexcept {
  const std::int32_t limit = kRim * surface.discontinuity(z8);
  const auto same = [&](int du, int dv) {
    const std::uint16_t beside = surface.depth(u + du, v + dv);
    return beside != 0 && std::abs(beside - z8) <= limit;
  };
  return same(-kRim, 0) && same(kRim, 0) && same(0, -kRim) && same(0, kRim);
}

}  // namespace

void take_picture(const Surface& surface, const CellMask& mask, std::int32_t normal_span,
                  ViewPicture& picture) noexcept {
  const Window& w = picture.window;
  for (int v = w.v0; v < w.v1; ++v)
    for (int u = w.u0; u < w.u1; ++u) {
      const std::size_t i = picture.index(u, v);
      const std::uint16_t z8 = surface.depth_at(u, v);
      picture.depth[i] = z8;
      picture.facing[i] = 0;
      if (z8 == 0 || mask.taken[row_major(v >> 1, mask.width, u >> 1)] == 0) continue;
      Normal16 n;
      if (!goes_on(surface, u, v, z8) ||
          !surface.normal(u, v, Surface::normal_step(z8, PixelSpan{normal_span}), n))
        continue;
      // -n · ray with the ray's third component 1: vertex / z.
      const IntPoint p = surface.vertex(u, v, z8);
      const std::int64_t dot = -(static_cast<std::int64_t>(n.x) * p.x + static_cast<std::int64_t>(n.y) * p.y +
                                 static_cast<std::int64_t>(n.z) * p.z);
      const auto facing = static_cast<std::int32_t>(dot / (static_cast<std::int64_t>(p.z) << 7));
      if (facing >= kLeastFacingView) picture.facing[i] = static_cast<std::uint8_t>(std::min(facing, 255));
    }
}

}  // namespace pliant

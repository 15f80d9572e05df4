#include "core/track/aside.hpp"

#include <algorithm>
#include <array>

#include "core/fixed/integer_root.hpp"
#include "core/track/shadow.hpp"

namespace pliant {

bool find_aside(const Surface& surface, const AsideReach& reach, int u, int v, const IntPoint& at,
                const IntPoint& n, Aside& found) noexcept {
  if (surface.depth(u, v) == 0 && in_shadow(surface, u, v, at.z, reach.outward, reach.step)) return false;
  const std::int32_t farthest = std::min(reach.inward, kFarthestReading);
  std::int64_t best = static_cast<std::int64_t>(farthest) * farthest;
  IntPoint nearest;
  bool any = false;
  constexpr std::array<std::array<int, 2>, 4> kDirections = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  for (const auto& direction : kDirections)
    for (int k = 1; k <= kLooksAside; ++k) {
      const int uu = u + direction[0] * k * reach.step, vv = v + direction[1] * k * reach.step;
      const std::uint16_t z8 = surface.depth(uu, vv);
      const std::int32_t gap = 2 * z8 - at.z;
      if (z8 == 0 || gap > reach.inward || -gap > reach.outward) continue;
      const IntPoint q = surface.vertex(uu, vv, z8);
      const std::int64_t square = squared_distance(q, at);
      if (square < best && surface.faces(uu, vv, Surface::normal_step(z8, reach.spacing), n)) {
        best = square;
        nearest = q;
        found.match = vv * surface.width() + uu;
        any = true;
      }
      break;  // what lies beyond the first is farther
    }
  if (!any || best == 0) return false;
  const IntPoint d{nearest.x - at.x, nearest.y - at.y, nearest.z - at.z};
  found.distance = static_cast<std::int32_t>(integer_sqrt(static_cast<std::uint32_t>(best)));
  found.direction = {d.x * 16384 / found.distance, d.y * 16384 / found.distance,
                     d.z * 16384 / found.distance};
  return true;
}

}  // namespace pliant

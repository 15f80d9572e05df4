#include "core/track/sight.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/track/aside.hpp"

namespace pliant {

Sighting::Look Sighting::look(const IntPoint& point, const IntPoint& normal) const noexcept {
  Look out;
  out.normal = normal;
  out.point = point;
  int u = 0, v = 0;
  if (!faces_camera(point, normal, 0) || !projector_.project(point, u, v)) return out;
  out.facing = true;
  const std::int32_t limit = tolerance_.deformed(point.z);
  // Where the surface is steep, a reading within the limit of a point lies farther off in depth.
  const std::int32_t deepest = std::min(4 * limit, kFarthestReading);
  const auto is_near = [&](std::uint16_t z8) { return z8 != 0 && std::abs(2 * z8 - point.z) <= deepest; };
  const std::uint16_t centre = surface_.depth_at(u, v);
  int best_u = u, best_v = v;
  bool agrees = is_near(centre) && agrees_with(u, v, centre, limit, point, normal, out.residual);
  if (!agrees)
    for (int vv = v - 1; vv <= v + 1; ++vv)
      for (int uu = u - 1; uu <= u + 1; ++uu) {
        const std::uint16_t z8 = surface_.depth_at(uu, vv);
        std::int32_t residual = 0;
        if (!is_near(z8) || (uu == u && vv == v) ||
            !agrees_with(uu, vv, z8, limit, point, normal, residual) ||
            (agrees && std::abs(residual) >= std::abs(out.residual)))
          continue;
        agrees = true;
        out.residual = residual;
        best_u = uu;
        best_v = vv;
      }
  if (agrees) {
    out.sight = Sight::agrees;
    out.match = best_v * surface_.width() + best_u;
    return out;
  }
  if (centre == 0) return out;
  const IntPoint q = surface_.vertex(u, v, centre);
  out.match = v * surface_.width() + u;
  const std::int32_t gap = std::min(std::abs(q.z - point.z), kFarthestReading);
  out.sight = q.z > point.z ? Sight::in_front : Sight::behind;
  out.residual =
      gap == kFarthestReading ? (q.z > point.z ? -gap : gap) : plane_distance(q, point, normal) >> 4;
  return out;
}

bool Sighting::look_beside(std::int32_t reach, Look& look) const noexcept {
  int u = 0, v = 0;
  if (!look.facing || !projector_.project(look.point, u, v)) return false;
  reach = std::min(reach, kFarthestReading);
  const int step = std::max(1, projector_.pixels(reach, look.point.z) / kLooksAside);
  Aside aside;
  if (!find_aside(surface_, {reach, reach, step, spacing_}, u, v, look.point, look.normal, aside))
    return false;
  look.sight = Sight::agrees;
  look.match = aside.match;
  look.residual = aside.distance;
  look.normal = aside.direction;
  return true;
}

bool Sighting::agrees_with(int u, int v, std::uint16_t z8, std::int32_t limit, const IntPoint& point,
                           const IntPoint& normal, std::int32_t& residual) const noexcept {
  residual = plane_distance(surface_.vertex(u, v, z8), point, normal) >> 4;
  return std::abs(residual) <= limit && surface_.faces(u, v, Surface::normal_step(z8, spacing_), normal);
}

}  // namespace pliant

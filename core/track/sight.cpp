#include "core/track/sight.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/track/aside.hpp"

namespace pliant {

namespace {

/// Where the surface is steep, a reading within the limit of a point lies farther off in depth.
bool is_near(std::uint16_t z8, const IntPoint& point, std::int32_t limit) noexcept {
  return z8 != 0 && std::abs(2 * z8 - point.z) <= 4 * limit;
}

}  // namespace

Sighting::Look Sighting::look(const IntPoint& point, const IntPoint& normal) const noexcept {
  Look out;
  out.normal = normal;
  out.point = point;
  int u = 0, v = 0;
  if (!faces_camera(out.point, out.normal, 0) || !projector_.project(out.point, u, v)) return out;
  out.facing = true;
  const std::int32_t limit = tolerance_.deformed(out.point.z);
  if (try_pixel(u, v, limit, out)) return out;
  const std::uint16_t centre = surface_.depth(u, v);
  Look best = out;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du) {
      if ((du == 0 && dv == 0) || !is_near(surface_.depth(u + du, v + dv), out.point, limit)) continue;
      Look other = out;
      if (try_pixel(u + du, v + dv, limit, other) &&
          (best.sight == Sight::none || std::abs(other.residual) < std::abs(best.residual)))
        best = other;
    }
  if (best.sight == Sight::agrees) return best;
  if (centre == 0) return out;
  const IntPoint q = surface_.vertex(u, v, centre);
  out.match = v * surface_.width() + u;
  const std::int32_t gap = std::min(std::abs(q.z - out.point.z), 8191);
  out.sight = q.z > out.point.z ? Sight::in_front : Sight::behind;
  out.residual =
      gap == 8191 ? (q.z > out.point.z ? -8191 : 8191) : plane_distance(q, out.point, out.normal) >> 4;
  return out;
}

bool Sighting::look_beside(std::int32_t reach, Look& look) const noexcept {
  int u = 0, v = 0;
  if (!look.facing || !projector_.project(look.point, u, v)) return false;
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

bool Sighting::try_pixel(int u, int v, std::int32_t limit, Look& out) const noexcept {
  const std::uint16_t z8 = surface_.depth(u, v);
  if (!is_near(z8, out.point, limit)) return false;
  const IntPoint q = surface_.vertex(u, v, z8);
  const std::int32_t residual = plane_distance(q, out.point, out.normal) >> 4;
  if (std::abs(residual) > limit) return false;
  if (!surface_.faces(u, v, Surface::normal_step(z8, spacing_), out.normal)) return false;
  out.sight = Sight::agrees;
  out.residual = residual;
  out.match = v * surface_.width() + u;
  return true;
}

}  // namespace pliant

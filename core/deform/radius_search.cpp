#include "core/deform/radius_search.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/fixed/integer_root.hpp"

namespace pliant {

namespace {

constexpr int kMostPixels = 20;  // reach of a search
constexpr int kLooks = 6;        // to each side

std::int64_t square_distance(const IntPoint& a, const IntPoint& b) noexcept {
  const std::int64_t x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return x * x + y * y + z * z;
}

bool is_taken(std::span<const std::uint32_t> taken, std::int32_t pixel) noexcept {
  return (taken[static_cast<std::size_t>(pixel >> 5)] >> (pixel & 31) & 1U) != 0;
}

/// Nearest free reading to `aim` that lies within `radius` of `rigid`.
std::int32_t nearest_free(const Surface& surface, const Projector& projector, const IntPoint& rigid,
                          const IntPoint& aim, std::int32_t radius, std::span<const std::uint32_t> taken,
                          IntPoint& found) noexcept {
  int u0 = 0, v0 = 0;
  if (!projector.project(aim, u0, v0)) return -1;
  const int reach = std::min(projector.pixels(radius, aim.z), kMostPixels);
  const int step = std::max(1, reach / kLooks);
  const std::int64_t most = static_cast<std::int64_t>(radius) * radius;
  std::int64_t best = most;
  std::int32_t match = -1;
  for (int dv = -reach; dv <= reach; dv += step)
    for (int du = -reach; du <= reach; du += step) {
      const int u = u0 + du, v = v0 + dv;
      const std::uint16_t z8 = surface.depth(u, v);
      if (z8 == 0) continue;
      const std::int32_t pixel = v * surface.width() + u;
      const IntPoint q = surface.vertex(u, v, z8);
      const std::int64_t square = square_distance(q, aim);
      if (square >= best || square_distance(q, rigid) > most || is_taken(taken, pixel)) continue;
      best = square;
      match = pixel;
      found = q;
    }
  return match;
}

}  // namespace

void search_deformed(const ModelTables& model, const Surface& surface, const Projector& projector,
                     const RegionSet& regions, const RadiusSearchSettings& settings,
                     std::span<std::uint32_t> taken, PointState& points) noexcept {
  (void)regions;
  std::fill(taken.begin(), taken.end(), 0U);
  bool any = false;
  for (std::size_t i = 0; i < model.size; ++i) {
    if (points.label[i] >= 0) {
      const std::int32_t pixel = points.match[i];
      taken[static_cast<std::size_t>(pixel >> 5)] |= 1U << (pixel & 31);
      points.offset[i] = {};
    }
    any = any || points.label[i] == kDeformed;
  }
  if (any) {
    for (std::size_t i = 0; i < model.size; ++i) {
      if (points.label[i] != kDeformed) continue;
      const IntPoint rigid = points.position[i];
      const IntPoint o = points.offset[i];
      IntPoint q;
      points.match[i] = nearest_free(surface, projector, rigid, {rigid.x + o.x, rigid.y + o.y, rigid.z + o.z},
                                     settings.radius, taken, q);
      if (points.match[i] >= 0) points.offset[i] = {q.x - rigid.x, q.y - rigid.y, q.z - rigid.z};
    }
    for (int round = 0; round < settings.smoothing; ++round)
      for (std::size_t i = 0; i < model.size; ++i) {
        if (points.label[i] != kDeformed) continue;
        std::int64_t x = 0, y = 0, z = 0, count = 0;
        for (const std::uint16_t n : model.model->neighbours(i)) {
          if (n >= model.size || points.label[n] == kNotObserved) continue;
          x += points.offset[n].x;
          y += points.offset[n].y;
          z += points.offset[n].z;
          ++count;
        }
        if (count == 0) continue;
        const IntPoint mean{static_cast<std::int32_t>(x / count), static_cast<std::int32_t>(y / count),
                            static_cast<std::int32_t>(z / count)};
        IntPoint& o = points.offset[i];
        // found points keep half of their own
        o = points.match[i] >= 0 ? IntPoint{(o.x + mean.x) / 2, (o.y + mean.y) / 2, (o.z + mean.z) / 2}
                                 : mean;
      }
  }
  for (std::size_t i = 0; i < model.size; ++i) {
    IntPoint& p = points.position[i];
    const IntPoint o = points.offset[i];
    p = {p.x + o.x, p.y + o.y, p.z + o.z};
    if (points.label[i] != kDeformed) continue;
    points.residual[i] = 0;
    if (points.match[i] < 0) continue;
    const int u = points.match[i] % surface.width(), v = points.match[i] / surface.width();
    const IntPoint q = surface.vertex(u, v, surface.depth(u, v));
    points.residual[i] = static_cast<std::int32_t>(
        integer_sqrt(static_cast<std::uint32_t>(std::min<std::int64_t>(square_distance(p, q), 0xFFFFFFFF))));
  }
}

}  // namespace pliant

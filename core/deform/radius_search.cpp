#include "core/deform/radius_search.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/fixed/integer_root.hpp"

namespace pliant {

namespace {

constexpr int kMostPixels = 20;  // reach of a search
constexpr int kLooks = 6;        // to each side

bool is_taken(std::span<const std::uint32_t> taken, std::int32_t pixel) noexcept {
  return (taken[static_cast<std::size_t>(pixel >> 5)] >> (pixel & 31) & 1U) != 0;
}

/// Nearest free reading to `aim` within `radius`.
std::int32_t nearest_free(const Surface& surface, const Projector& projector, const IntPoint& aim,
                          std::int32_t radius, std::span<const std::uint32_t> taken,
                          IntPoint& found) noexcept {
  int u0 = 0, v0 = 0;
  if (!projector.project(aim, u0, v0)) return -1;
  const int reach = std::min(projector.pixels(radius, aim.z), kMostPixels);
  const int step = std::max(1, reach / kLooks);
  std::int64_t best = static_cast<std::int64_t>(radius) * radius;
  std::int32_t match = -1;
  for (int dv = -reach; dv <= reach; dv += step)
    for (int du = -reach; du <= reach; du += step) {
      const int u = u0 + du, v = v0 + dv;
      const std::uint16_t z8 = surface.depth(u, v);
      if (z8 == 0) continue;
      const std::int32_t pixel = v * surface.width() + u;
      const IntPoint q = surface.vertex(u, v, z8);
      const std::int64_t square = squared_distance(q, aim);
      if (square >= best || is_taken(taken, pixel)) continue;
      best = square;
      match = pixel;
      found = q;
    }
  return match;
}

void take(std::span<std::uint32_t> taken, std::int32_t pixel) noexcept {
  taken[static_cast<std::size_t>(pixel >> 5)] |= 1U << (pixel & 31);
}

}  // namespace

void search_deformed(const ModelTables& model, const Surface& surface, const Projector& projector,
                     std::int32_t radius, std::span<std::uint32_t> taken, PointState& points) noexcept {
  std::fill(taken.begin(), taken.end(), 0U);
  bool any = false;
  for (std::size_t i = 0; i < model.size; ++i) {
    if (points.match[i] >= 0) take(taken, points.match[i]);
    any = any || (points.label[i] == kDeformed && points.match[i] < 0);
  }
  if (!any) return;
  for (std::size_t i = 0; i < model.size; ++i) {
    if (points.label[i] != kDeformed || points.match[i] >= 0) continue;
    const IntPoint& p = points.position[i];
    IntPoint q;
    points.match[i] = nearest_free(surface, projector, p, radius, taken, q);
    if (points.match[i] < 0) continue;
    take(taken, points.match[i]);
    points.residual[i] = static_cast<std::int32_t>(
        integer_sqrt(static_cast<std::uint32_t>(std::min<std::int64_t>(squared_distance(p, q), 0xFFFFFFFF))));
  }
}

}  // namespace pliant

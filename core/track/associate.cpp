#include "core/track/associate.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/track/aside.hpp"
#include "core/track/contour.hpp"
#include "core/track/placed_points.hpp"

namespace pliant {

namespace {

/// What the kernel needs of regions and settings.
struct Plan {
  RegionPoses poses;
  std::array<std::size_t, limits::kMaxRegions> sizes{};  // of the sampling, by region
  std::size_t size = 0;
  std::int32_t gate = 0;  // 1/16 mm, at most kFarthestReading
  PixelSpan spacing;

  [[nodiscard]] AsideReach aside_at(const Projector& projector, std::int32_t z) const noexcept {
    return {gate, gate, std::max(1, projector.pixels(gate, z) / kLooksAside), spacing};
  }
};

Correspondence correspondence(const IntPoint& p, const IntPoint& n, std::size_t i, std::int32_t residual,
                              std::size_t region) noexcept {
  return {p,
          static_cast<std::int16_t>(n.x),
          static_cast<std::int16_t>(n.y),
          static_cast<std::int16_t>(n.z),
          static_cast<std::uint16_t>(i),
          residual,
          static_cast<std::int8_t>(region)};
}

/// The integer kernel, on its own so that it can be looked at.
[[gnu::noinline]] std::size_t associate_points(const ModelTables& model, const Surface& surface,
                                               const Projector& projector, const Plan& plan,
                                               PointState& points) noexcept {
  std::size_t count = 0;
  PlacedPoints based;  // under the base's pose: most points are the base's
  for (std::size_t first = 0; first < plan.size; first += PlacedPoints::kMost) {
    const std::size_t end = std::min(first + PlacedPoints::kMost, plan.size);
    if (first < plan.sizes[0]) based.place({model, first}, end - first, plan.poses[0]);
    for (std::size_t i = first; i < end; ++i) {
      const auto k = static_cast<std::size_t>(points.home[i]);
      if (i >= plan.sizes[k] || points.evidence[i] >= kEvidenceDeformed) continue;
      if (k == 0 && based.side[i - first] != Side::facing) continue;
      const IntPoint n =
          k == 0 ? based.normal(i - first) : plan.poses[k].direction(model.nx[i], model.ny[i], model.nz[i]);
      const IntPoint p =
          k == 0 ? based.point(i - first) : plan.poses[k].point(model.x[i], model.y[i], model.z[i]);
      if (k != 0 && !faces_camera(p, n, kCos75)) {
        std::int32_t distance = 0;
        if (on_rim(p, n) && find_contour(surface, projector, {plan.gate, plan.gate}, p, n, distance))
          points.correspondences[count++] = correspondence(p, n, i, distance * 16, k);
        continue;
      }
      int u = 0, v = 0;
      if (!projector.project(p, u, v)) continue;
      const std::uint16_t z8 = surface.depth_at(u, v);
      if (z8 == 0 || 2 * z8 - p.z > plan.gate) {
        Aside aside;
        if (k != 0 && find_aside(surface, plan.aside_at(projector, p.z), u, v, p, n, aside))
          points.correspondences[count++] = correspondence(p, aside.direction, i, aside.distance * 16, k);
        continue;
      }
      if (p.z - 2 * z8 > plan.gate) continue;
      const IntPoint q = surface.vertex(u, v, z8);
      const std::int32_t residual = plane_distance(q, p, n);
      if (std::abs(residual) > plan.gate * 16) continue;
      if (!surface.faces(u, v, Surface::normal_step(z8, plan.spacing), n)) continue;
      points.correspondences[count++] = correspondence(p, n, i, residual, k);
    }
  }
  return count;
}

}  // namespace

void associate(const ModelTables& model, const Surface& surface, const Projector& projector,
               const RegionSet& regions, const AssociateSettings& settings, PointState& points) noexcept {
  Plan plan;
  plan.poses = fixed_poses(regions, model.centre);
  plan.size = std::min(settings.points, model.size);
  for (const std::int8_t home : points.home) ++plan.sizes[static_cast<std::size_t>(home)];
  for (std::size_t& size : plan.sizes)
    size = size <= kEnoughOfRegion ? plan.size : std::min(plan.size, model.size * kEnoughOfRegion / size);
  plan.gate = std::min(settings.gate, kFarthestReading);
  plan.spacing = surface.pixel_span(model.spacing / kUnitsPerMetre);
  points.correspondence_count = associate_points(model, surface, projector, plan, points);
}

}  // namespace pliant

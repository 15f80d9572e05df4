#include "core/track/associate.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/track/aside.hpp"
#include "core/track/contour.hpp"
#include "core/track/placed_points.hpp"

namespace pliant {

namespace {

/// What the kernel needs of regions, by region.
struct Plan {
  RegionPoses poses;
  std::array<std::size_t, limits::kMaxRegions> sizes{};   // of the sampling
  std::array<std::int32_t, limits::kMaxRegions> gates{};  // 1/16 mm, at most kFarthestReading
  std::size_t size = 0;                                   // the largest sampling
  PixelSpan spacing;

  [[nodiscard]] AsideReach aside_at(const Projector& projector, std::int32_t gate,
                                    std::int32_t z) const noexcept {
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

/// The correspondence of point `i` at `p` with normal `n`, which faces the camera or is on its region's
/// outline, if it has one. The base has readings enough without what edges tell.
inline bool find_correspondence(const Surface& surface, const Projector& projector, const Plan& plan,
                                std::size_t i, std::size_t region, const IntPoint& p, const IntPoint& n,
                                Side side, Correspondence& found) noexcept {
  const std::int32_t gate = plan.gates[region];
  if (side == Side::rim) {
    std::int32_t distance = 0;
    if (!find_contour(surface, projector, {gate, gate}, p, n, distance)) return false;
    found = correspondence(p, n, i, distance * 16, region);
    return true;
  }
  int u = 0, v = 0;
  if (!projector.project(p, u, v)) return false;
  const std::uint16_t z8 = surface.depth_at(u, v);
  if (z8 == 0 || 2 * z8 - p.z > gate) {
    Aside aside;
    if (region == 0 || !find_aside(surface, plan.aside_at(projector, gate, p.z), u, v, p, n, aside))
      return false;
    found = correspondence(p, aside.direction, i, aside.distance * 16, region);
    return true;
  }
  if (p.z - 2 * z8 > gate) return false;
  const std::int32_t residual = plane_distance(surface.vertex(u, v, z8), p, n);
  if (std::abs(residual) > gate * 16 || !surface.faces(u, v, Surface::normal_step(z8, plan.spacing), n))
    return false;
  found = correspondence(p, n, i, residual, region);
  return true;
}

/// The integer kernel, on its own so that it can be looked at. Patch by patch: most points of one have one
/// home, and stand beside each other in the picture.
[[gnu::noinline]] std::size_t associate_points(const ModelTables& model, const Surface& surface,
                                               const Projector& projector, const Plan& plan,
                                               PointState& points) noexcept {
  const PatchPoints& by_patch = model.by_patch;
  std::size_t count = 0;
  PlacedPoints placed;
  for (std::size_t p = 0; p < by_patch.begin.size(); ++p) {
    const std::size_t begin = by_patch.begin[p],
                      end = by_patch.below(plan.size, begin, begin + by_patch.count[p]);
    if (begin == end) continue;
    const auto lead = static_cast<std::size_t>(points.home[by_patch.index[begin]]);
    for (std::size_t first = begin; first < end; first += PlacedPoints::kMost) {
      const std::size_t most = std::min(first + PlacedPoints::kMost, end);
      placed.place({by_patch, first},
                   PatchPoints::filled_up(by_patch.below(plan.sizes[lead], first, most) - first),
                   plan.poses[lead]);
      for (std::size_t at = first; at < most; ++at) {
        const std::size_t i = by_patch.index[at], k = at - first;
        const auto region = static_cast<std::size_t>(points.home[i]);
        if (i >= plan.sizes[region] || points.evidence[i] >= kEvidenceDeformed) continue;
        if (region != lead) {
          const FixedPose& pose = plan.poses[region];
          placed.put(k, pose.point(model.x[i], model.y[i], model.z[i]),
                     pose.direction(model.nx[i], model.ny[i], model.nz[i]));
        }
        const Side side = placed.side[k];
        if (side == Side::away || (region == 0 && side == Side::rim)) continue;
        if (find_correspondence(surface, projector, plan, i, region, placed.point(k), placed.normal(k), side,
                                points.correspondences[count]))
          ++count;
      }
    }
  }
  return count;
}

}  // namespace

void associate(const ModelTables& model, const Surface& surface, const Projector& projector,
               const RegionSet& regions, const SearchReaches& reaches, PointState& points) noexcept {
  Plan plan;
  plan.poses = fixed_poses(regions, model.centre);
  for (const std::int8_t home : points.home) ++plan.sizes[static_cast<std::size_t>(home)];
  for (std::size_t k = 0; k < reaches.size(); ++k) {
    plan.gates[k] = std::min(reaches[k].gate, kFarthestReading);
    if (plan.sizes[k] > 0)
      plan.sizes[k] = std::min({reaches[k].points, model.size, kEnoughOfRegion * model.size / plan.sizes[k]});
    plan.size = std::max(plan.size, plan.sizes[k]);
  }
  plan.spacing = surface.pixel_span(model.spacing / kUnitsPerMetre);
  points.correspondence_count = associate_points(model, surface, projector, plan, points);
}

}  // namespace pliant

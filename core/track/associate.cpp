#include "core/track/associate.hpp"

#include <algorithm>
#include <cstdlib>

namespace pliant {

namespace {

constexpr std::int32_t kCos75 = 4240;  // Q14

}  // namespace

void associate(const ModelTables& model, const Surface& surface, const Projector& projector,
               const RegionSet& regions, const AssociateSettings& settings, PointState& points) noexcept {
  std::array<FixedPose, limits::kMaxRegions> poses;
  std::array<bool, limits::kMaxRegions> wanted{};
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].alive) continue;
    poses[k] = FixedPose(regions[k].pose, model.centre);
    wanted[k] = settings.only_region < 0 || settings.only_region == static_cast<std::int8_t>(k);
  }
  const std::int32_t gate = std::min(settings.gate, 8191);
  const double spacing_metres = model.spacing / kUnitsPerMetre;
  std::size_t count = 0;
  const std::size_t size = std::min(settings.points, model.size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto k = static_cast<std::size_t>(points.home[i]);
    if (!wanted[k] || (!settings.with_deformed && points.evidence[i] >= kEvidenceDeformed)) continue;
    const IntPoint n = poses[k].direction(model.nx[i], model.ny[i], model.nz[i]);
    const IntPoint p = poses[k].point(model.x[i], model.y[i], model.z[i]);
    if (!faces_camera(p, n, kCos75)) continue;
    int u = 0, v = 0;
    if (!projector.project(p, u, v)) continue;
    const std::uint16_t z8 = surface.depth(u, v);
    if (z8 == 0 || std::abs(2 * z8 - p.z) > gate) continue;
    const IntPoint q = surface.vertex(u, v, z8);
    const std::int32_t residual = plane_distance(q, p, n);
    if (std::abs(residual) > gate * 16) continue;
    if (settings.check_normals && !surface.faces(u, v, surface.normal_step(z8, spacing_metres), n)) continue;
    points.correspondences[count++] = {p,
                                       static_cast<std::int16_t>(n.x),
                                       static_cast<std::int16_t>(n.y),
                                       static_cast<std::int16_t>(n.z),
                                       static_cast<std::uint16_t>(i),
                                       residual,
                                       static_cast<std::int8_t>(k)};
  }
  points.correspondence_count = count;
}

}  // namespace pliant

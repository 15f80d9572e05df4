#include "core/registration/cloud_labels.hpp"

#include <cmath>

#include "core/detect/fast_transform.hpp"

namespace pliant {

SurfaceGap surface_gap(const ModelView& model, std::size_t i, const RigidTransform& pose,
                       const PointGrid& grid, double across, double depth) noexcept {
  const FastTransform fast(pose);
  const Point3f p = fast.point(model.positions()[i]);
  const Point3f n = fast.direction(model.normals()[i]);
  const auto wide = static_cast<float>(across), deep = static_cast<float>(depth);
  SurfaceGap gap;
  float sum = 0, squares = 0, best = 0;
  grid.visit_within(
      p, std::sqrt(wide * wide + deep * deep), 512, [&](std::uint32_t j, const Point3f& q, float square) {
        const float along = n.x * (q.x - p.x) + n.y * (q.y - p.y) + n.z * (q.z - p.z);
        if (std::fabs(along) > deep || square - along * along > wide * wide) return;
        sum += along;
        squares += along * along;
        ++gap.count;
        if (gap.nearest == PointGrid::kNone || square < best || (square == best && j < gap.nearest)) {
          best = square;
          gap.nearest = j;
        }
      });
  if (gap.count == 0) return gap;
  const float n_points = static_cast<float>(gap.count);
  gap.along = sum / n_points;
  const float variance = squares / n_points - gap.along * gap.along;
  gap.spread = variance > 0 ? std::sqrt(variance) : 0;
  gap.distance = std::sqrt(best);
  return gap;
}

void IslandFilter::lay_out(Workspace& workspace, std::size_t points) noexcept {
  piece_ = workspace.take<std::uint32_t>(points);
  queue_ = workspace.take<std::uint16_t>(points);
}

}  // namespace pliant

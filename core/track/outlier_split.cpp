#include "core/track/outlier_split.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/track/align.hpp"
#include "core/track/associate.hpp"
#include "core/track/sight.hpp"

namespace pliant {

namespace {

constexpr int kFitIterations = 8;
constexpr std::size_t kFitPoints = 400;

/// A connected group of outliers: its points stand at the front of PointState::queue.
struct Group {
  std::size_t size = 0;
  std::int8_t home = 0;  ///< of most of its points
};

bool is_outlier(const PointState& points, std::size_t i) noexcept {
  return points.label[i] == kDeformed;
}

/// Marks the points of the largest group with 1 in `points.group` and lists them in `points.queue`.
Group largest_group(const ModelTables& model, PointState& points) noexcept {
  for (std::size_t i = 0; i < model.size; ++i) points.group[i] = 0;
  std::int32_t component = 0, largest = 0;
  std::size_t largest_size = 0;
  for (std::size_t seed = 0; seed < model.size; ++seed) {
    if (points.group[seed] != 0 || !is_outlier(points, seed)) continue;
    ++component;
    std::size_t head = 0, tail = 0;
    points.queue[tail++] = static_cast<std::uint16_t>(seed);
    points.group[seed] = component;
    while (head < tail) {
      const std::size_t i = points.queue[head++];
      for (const std::uint16_t n : model.model->neighbours(i)) {
        if (n >= model.size || points.group[n] != 0 || !is_outlier(points, n)) continue;
        points.group[n] = component;
        points.queue[tail++] = n;
      }
    }
    if (tail > largest_size) {
      largest_size = tail;
      largest = component;
    }
  }
  Group group;
  std::array<std::uint32_t, limits::kMaxRegions> homes{};
  for (std::size_t i = 0; i < model.size; ++i) {
    const bool mine = largest != 0 && points.group[i] == largest;
    points.group[i] = mine ? 1 : 0;
    if (!mine) continue;
    points.queue[group.size++] = static_cast<std::uint16_t>(i);  // in the model's order: a uniform sampling
    ++homes[static_cast<std::size_t>(points.home[i])];
  }
  group.home = static_cast<std::int8_t>(std::max_element(homes.begin(), homes.end()) - homes.begin());
  return group;
}

/// The reading nearest to `p` within `reach` pixels whose surface faces along `n`; steps keep the looks
/// below 81.
bool nearest_reading(const Surface& surface, const Projector& projector, const IntPoint& p, const IntPoint& n,
                     std::int32_t radius, int normal_step, IntPoint& q) noexcept {
  int u0 = 0, v0 = 0;
  if (!projector.project(p, u0, v0)) return false;
  const int reach = std::min(projector.pixels(radius, p.z), 24);
  const int step = std::max(1, (reach + 3) / 4);
  std::int64_t best = static_cast<std::int64_t>(radius) * radius;
  bool found = false;
  for (int dv = -reach; dv <= reach; dv += step)
    for (int du = -reach; du <= reach; du += step) {
      const std::uint16_t z8 = surface.depth(u0 + du, v0 + dv);
      if (z8 == 0) continue;
      const IntPoint r = surface.vertex(u0 + du, v0 + dv, z8);
      const std::int64_t dx = r.x - p.x, dy = r.y - p.y, dz = r.z - p.z;
      const std::int64_t square = dx * dx + dy * dy + dz * dz;
      if (square >= best || !surface.faces(u0 + du, v0 + dv, normal_step, n)) continue;
      best = square;
      q = r;
      found = true;
    }
  return found;
}

/// Correspondences of the group's points under the pose of region `slot`, nearest reading within `radius`.
void associate_group(const ModelTables& model, const Surface& surface, const Projector& projector,
                     const Group& group, const TrackedRegion& region, std::int8_t slot, std::int32_t radius,
                     PointState& points) noexcept {
  const FixedPose pose(region.pose, model.centre);
  const std::size_t stride = std::max<std::size_t>(1, group.size / kFitPoints);
  std::size_t count = 0;
  for (std::size_t g = 0; g < group.size; g += stride) {
    const std::size_t i = points.queue[g];
    const IntPoint n = pose.direction(model.nx[i], model.ny[i], model.nz[i]);
    const IntPoint p = pose.point(model.x[i], model.y[i], model.z[i]);
    if (!faces_camera(p, n, 1638)) continue;
    IntPoint q;
    const int step = surface.normal_step(static_cast<std::uint16_t>(std::clamp(p.z / 2, 1, 65535)),
                                         model.spacing / kUnitsPerMetre);
    if (!nearest_reading(surface, projector, p, n, radius, step, q)) continue;
    points.correspondences[count++] = {p,
                                       static_cast<std::int16_t>(n.x),
                                       static_cast<std::int16_t>(n.y),
                                       static_cast<std::int16_t>(n.z),
                                       static_cast<std::uint16_t>(i),
                                       plane_distance(q, p, n),
                                       slot};
  }
  points.correspondence_count = count;
}

}  // namespace

bool split_outliers(const ModelTables& model, const Surface& surface, const Projector& projector,
                    const Tolerance& tolerance, std::uint32_t fewest_points, std::size_t slot,
                    RegionSet& regions, PointState& points) noexcept {
  const Group group = largest_group(model, points);
  if (group.size < fewest_points) return false;

  const TrackedRegion& home = regions[static_cast<std::size_t>(group.home)];
  TrackedRegion candidate;
  candidate.alive = true;
  candidate.parent = group.home;
  candidate.pose = candidate.predicted = home.pose;
  candidate.last_pose = home.last_pose;
  RegionSet trial;  // the candidate alone, for align()
  trial[slot] = candidate;
  const double reach = 0.3 * model.model->radius() * kUnitsPerMetre;
  std::int32_t radius = std::min(static_cast<std::int32_t>(reach), 60 * kUnitsPerMillimetre);
  for (int iteration = 0; iteration < kFitIterations; ++iteration) {
    associate_group(model, surface, projector, group, trial[slot], static_cast<std::int8_t>(slot), radius,
                    points);
    AlignSettings align_settings;
    align_settings.widest = radius;
    align_settings.prior_rotation = 0.5;
    align_settings.prior_translation = 0.05;
    align(surface, align_settings, points, trial);
    radius = std::max(radius * 3 / 4, tolerance.deformed(8000) * 2);
  }

  const Sighting sighting(model, surface, projector, tolerance);
  const FixedPose pose(trial[slot].pose, model.centre);
  std::size_t follow = 0, seen = 0;
  std::int64_t sum = 0, depth = 0;
  for (std::size_t g = 0; g < group.size; ++g) {
    const Sighting::Look look = sighting.look(points.queue[g], pose);
    seen += look.facing ? 1 : 0;
    if (look.sight != Sight::agrees) continue;
    ++follow;
    sum += std::abs(look.residual);
    depth += look.point.z;
  }
  if (follow < fewest_points || follow * 10 < seen * 7) return false;
  const auto mean_depth = static_cast<std::int32_t>(depth / static_cast<std::int64_t>(follow));
  const auto mean_residual = static_cast<std::int32_t>(sum / static_cast<std::int64_t>(follow));
  const std::int32_t limit = tolerance.deformed(mean_depth);
  // As close as rigid surface: a uniform spread within the limit would give limit / 2.
  if (mean_residual > std::max(limit / 4, home.scale * 5 / 4)) return false;
  TrackedRegion& region = regions[slot];
  region = trial[slot];
  region.motion = home.motion;
  region.last_pose = region.pose;
  for (std::size_t g = 0; g < group.size; ++g) {
    const std::size_t i = points.queue[g];
    const Sighting::Look look = sighting.look(i, pose);
    if (look.sight != Sight::agrees) continue;
    points.home[i] = static_cast<std::int8_t>(slot);
    points.evidence[i] = 0;
    points.switching[i] = 0;
    points.sight[i] = look.sight;
    points.residual[i] = look.residual;
    points.match[i] = look.match;
    points.position[i] = look.point;
    points.label[i] = points.home[i];
  }
  return true;
}

}  // namespace pliant

#include "core/track/compare_poses.hpp"

#include <algorithm>
#include <cstdlib>

namespace pliant {

namespace {

/// So many points, a uniform sampling, tell two motions apart as well as all: their mean is known to a
/// twentieth of a reading's noise.
constexpr std::int64_t kEnough = 400;

/// So many tell it to a tenth: what they tell of a clear case is enough.
constexpr std::int64_t kFew = 64;

/// An outline of fewer points says nothing: a motion with six freedoms that was fitted to so few fits better
/// by chance.
constexpr std::int64_t kFewestOnRim = 16;

/// An outline that the better motion does not explain, to a tenth of the limit, is not the model's: it tells
/// nothing of motions.
constexpr std::int64_t kWellOutlined = 10;

/// Sums over points of how far the two poses put them from what is seen.
struct Sums {
  std::int64_t own = 0, other = 0, count = 0;

  void add(std::int32_t a, std::int32_t b) noexcept {
    own += a;
    other += b;
    ++count;
  }
  [[nodiscard]] double gap(std::int32_t limit) const noexcept {
    return count > 0 ? static_cast<double>(other - own) / (static_cast<double>(count) * limit) : 0;
  }
};

}  // namespace

double worse_by(const ModelTables& model, const PatchTables& patches, const Sighting& sighting,
                const PointState& points, const AskedPoints& asked, const RigidTransform& own,
                const RigidTransform& other) noexcept {
  const FixedPose own_pose(own, model.centre), other_pose(other, model.centre);
  const std::int32_t limit = sighting.tolerance().deformed(depth_of(own, model.centre));
  const std::int32_t pixel = sighting.pixel(depth_of(own, model.centre));
  // the outline is known to a pixel: what lies nearer lies on it
  const auto off_rim = [&](std::int32_t distance) {
    return std::clamp(std::abs(distance) - pixel, 0, limit);
  };
  Sums surface, rim;
  for (std::size_t i = 0; i < model.size && surface.count < kEnough; ++i) {
    if (points.home[i] != asked.region ||
        (asked.patches != nullptr && !asked.patches->has(patches.patch_of[i])))
      continue;
    std::int32_t at_own = 0, at_other = 0;
    if (asked.outline && sighting.from_contour(i, own_pose, 4 * limit, at_own) &&
        sighting.from_contour(i, other_pose, 4 * limit, at_other)) {
      rim.add(off_rim(at_own), off_rim(at_other));
      continue;
    }
    const Sighting::Look a = sighting.look(i, own_pose), b = sighting.look(i, other_pose);
    if (a.sight != Sight::agrees && b.sight != Sight::agrees) continue;
    surface.add(a.sight == Sight::agrees ? std::min(std::abs(a.residual), limit) : limit,
                b.sight == Sight::agrees ? std::min(std::abs(b.residual), limit) : limit);
    if (surface.count == kFew && surface.gap(limit) > asked.clear) return surface.gap(limit);
  }
  const double on_surface = surface.gap(limit);
  const bool outlined = rim.count >= kFewestOnRim && rim.own * kWellOutlined <= rim.count * limit;
  return outlined ? std::max(on_surface, rim.gap(limit)) : on_surface;
}

}  // namespace pliant

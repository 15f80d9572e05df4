#include "core/track/undecided.hpp"

#include <algorithm>
#include <cstdlib>

namespace pliant {

namespace {

/// What a point's readings say, in PointState::group.
enum Standing : std::int32_t { kOut = 0, kUndecided = 1, kDecided = 2 };

/// Share of the inlier limit by which one region must explain a reading better than another: three times
/// what smoothing leaves of the noise.
constexpr std::int32_t kClearly = 4;  // a fourth

Standing standing_of(const Sighting& sighting, const RegionBorders& borders, std::size_t patch,
                     const RegionPoses& poses, std::int32_t limit, std::size_t home, std::size_t i) noexcept {
  const Sighting::Look own = sighting.look(i, poses[home]);
  if (own.sight != Sight::agrees) return kOut;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (k == home || !borders.meets(patch, k)) continue;
    const Sighting::Look other = sighting.look(i, poses[k]);
    if (other.sight == Sight::agrees &&
        (std::abs(other.residual) - std::abs(own.residual)) * kClearly < limit)
      return kUndecided;
  }
  return kDecided;
}

/// Patches at the borders, and beside those: only their points have neighbours that may be undecided.
PatchSet about_borders(const PatchTables& patches, const RegionBorders& borders) noexcept {
  PatchSet set;
  for (std::size_t p = 0; p < patches.count; ++p)
    if (borders.has(p)) set.add(p);
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    if (!borders.has(border.a) && !borders.has(border.b)) continue;
    set.add(border.a);
    set.add(border.b);
  }
  return set;
}

}  // namespace

void settle_undecided(const ModelTables& model, const PatchTables& patches, const RegionBorders& borders,
                      const Sighting& sighting, const RegionSet& regions, PointState& points) noexcept {
  if (count_alive(regions) < 2) return;
  const RegionPoses poses = fixed_poses(regions, model.centre);
  const PatchSet about = about_borders(patches, borders);
  std::size_t head = 0, tail = 0;
  for (std::size_t i = 0; i < model.size; ++i) {
    if (!about.has(patches.patch_of[i])) {
      points.group[i] = kDecided;
      continue;
    }
    const auto home = static_cast<std::size_t>(points.home[i]);
    const std::size_t patch = patches.patch_of[i];
    points.group[i] =
        points.sight[i] == Sight::none || points.evidence[i] >= kEvidenceDeformed ? kOut
        : !borders.has(patch)
            ? kDecided
            : standing_of(sighting, borders, patch, poses,
                          sighting.tolerance().deformed(depth_of(regions[home].pose, model.centre)), home, i);
    if (points.group[i] == kDecided) points.queue[tail++] = static_cast<std::uint16_t>(i);
  }
  while (head < tail) {
    const std::size_t i = points.queue[head++];
    for (const std::uint16_t n : model.model->neighbours(i)) {
      if (n >= model.size || points.group[n] != kUndecided) continue;
      if (points.home[n] != points.home[i]) {
        if (sighting.look(n, poses[static_cast<std::size_t>(points.home[i])]).sight != Sight::agrees)
          continue;
        points.home[n] = points.home[i];
        points.switching[n] = 0;
        points.rival[n] = -1;
      }
      points.group[n] = kDecided;
      points.queue[tail++] = n;
    }
  }
}

}  // namespace pliant

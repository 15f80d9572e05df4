#include "core/track/label.hpp"

#include <algorithm>
#include <cstdlib>

#include "core/track/sight.hpp"

namespace pliant {

namespace {

constexpr std::uint8_t kSwitchAt = 16;  // evidence that moves a point to another region: two clear frames

void raise(std::uint8_t& counter, int by, int most) noexcept {
  counter = static_cast<std::uint8_t>(std::clamp(counter + by, 0, most));
}

std::span<const std::uint16_t> neighbours_of(const ModelTables& model, std::size_t i) noexcept {
  return model.model->neighbours(i);
}

using HomeCounts = std::array<int, limits::kMaxRegions>;

HomeCounts homes_around(const ModelTables& model, const PointState& points, std::size_t i) noexcept {
  HomeCounts counts{};
  for (const std::uint16_t n : neighbours_of(model, i))
    if (n < model.size) ++counts[static_cast<std::size_t>(points.home[n])];
  return counts;
}

/// Weighs the point's own region against those of its neighbours and moves it when the evidence suffices.
/// Beside how well each explains the reading, every neighbour has a say: regions are parts of the surface,
/// not scattered points.
bool consider_rivals(const ModelTables& model, const RegionSet& regions, const Sighting& sighting,
                     const std::array<FixedPose, limits::kMaxRegions>& poses, std::int32_t limit,
                     const Sighting::Look& own, PointState& points, std::size_t i) noexcept {
  const HomeCounts around = homes_around(model, points, i);
  const auto home = static_cast<std::size_t>(points.home[i]);
  const std::int32_t own_cost = own.sight == Sight::agrees ? std::abs(own.residual) : 2 * limit;
  std::int8_t best = -1;
  int best_gain = 0;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (k == home || !regions[k].alive || around[k] < 2) continue;
    const Sighting::Look other = sighting.look(i, poses[k]);
    if (other.sight != Sight::agrees) continue;
    const int gain = (own_cost - std::abs(other.residual)) * 8 / limit + around[k] - around[home];
    if (gain <= best_gain) continue;
    best = static_cast<std::int8_t>(k);
    best_gain = gain;
  }
  if (best < 0) {
    raise(points.switching[i], -4, kSwitchAt);
    return false;
  }
  if (points.rival[i] != best) {
    points.rival[i] = best;
    points.switching[i] = 0;
  }
  raise(points.switching[i], std::min(best_gain, 8), kSwitchAt);
  if (points.switching[i] < kSwitchAt) return false;
  points.home[i] = best;
  points.switching[i] = 0;
  points.rival[i] = -1;
  points.evidence[i] = 0;
  return true;
}

/// A point that is not seen goes with the region, of those around it first, under which free space allows it.
void carry_where_allowed(const ModelTables& model, const RegionSet& regions, const Sighting& sighting,
                         const std::array<FixedPose, limits::kMaxRegions>& poses, PointState& points,
                         std::size_t i) noexcept {
  if (!sighting.refuted(i, poses[static_cast<std::size_t>(points.home[i])])) return;
  const HomeCounts around = homes_around(model, points, i);
  int most = -1;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].alive || around[k] <= most || sighting.refuted(i, poses[k])) continue;
    most = around[k];
    points.home[i] = static_cast<std::int8_t>(k);
  }
}

/// Marks points behind the readings as bulged where the surface climbs to them steadily from agreeing
/// neighbours.
std::uint32_t flood_bulges(const ModelTables& model, const Surface& surface, PointState& points) noexcept {
  std::size_t head = 0, tail = 0;
  for (std::size_t i = 0; i < model.size; ++i) {
    points.group[i] = points.sight[i] == Sight::agrees ? 1 : 0;
    if (points.group[i] != 0) points.queue[tail++] = static_cast<std::uint16_t>(i);
  }
  std::uint32_t bulged = 0;
  while (head < tail) {  // every point enters the queue once
    const std::size_t i = points.queue[head++];
    for (const std::uint16_t n : neighbours_of(model, i)) {
      if (n >= model.size || points.group[n] != 0 || points.sight[n] != Sight::behind) continue;
      // a slope of 45° against the rest shape, and the noise of two readings
      const std::int32_t climb = std::abs(points.residual[n] - points.residual[i]);
      if (climb > model.spacing + 3 * surface.sigma(points.position[n].z)) continue;
      points.group[n] = 1;
      ++bulged;
      points.queue[tail++] = n;
    }
  }
  return bulged;
}

}  // namespace

SightCounts label(const ModelTables& model, const Surface& surface, const Projector& projector,
                  const RegionSet& regions, const Tolerance& tolerance, PointState& points) noexcept {
  std::array<FixedPose, limits::kMaxRegions> poses;
  int alive = 0;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].alive) continue;
    poses[k] = FixedPose(regions[k].pose, model.centre);
    ++alive;
  }
  const Sighting sighting(model, surface, projector, tolerance);
  SightCounts counts;
  for (std::size_t i = 0; i < model.size; ++i) {
    Sighting::Look look = sighting.look(i, poses[static_cast<std::size_t>(points.home[i])]);
    if (alive > 1 &&
        consider_rivals(model, regions, sighting, poses, tolerance.deformed(look.point.z), look, points, i))
      look = sighting.look(i, poses[static_cast<std::size_t>(points.home[i])]);
    if (alive > 1 && look.sight == Sight::none) {
      carry_where_allowed(model, regions, sighting, poses, points, i);
      const auto home = static_cast<std::size_t>(points.home[i]);
      look.point = poses[home].point(model.x[i], model.y[i], model.z[i]);
    }
    points.sight[i] = look.sight;
    points.residual[i] = look.residual;
    points.match[i] = look.match;
    points.position[i] = look.point;
    counts.facing += look.facing ? 1 : 0;
  }
  points.frames = std::min(points.frames + 1, kMisfitFirstFrames + 1);
  counts.bulged = flood_bulges(model, surface, points);

  for (std::size_t i = 0; i < model.size; ++i) {
    const Sight sight = points.sight[i];
    const bool bulged = sight == Sight::behind && points.group[i] != 0;
    if (sight == Sight::agrees) {
      ++counts.agree;
      raise(points.evidence[i], -2, kEvidenceMax);
      points.misfit[i] += (points.residual[i] * 16 - points.misfit[i]) /
                          (points.frames <= kMisfitFirstFrames ? points.frames : kMisfitFrames);
    } else if (sight == Sight::in_front || bulged) {
      raise(points.evidence[i], 2, kEvidenceMax);
    } else if (points.evidence[i] < kEvidenceDeformed) {
      raise(points.evidence[i], -1, kEvidenceMax);
    }
    counts.in_front += sight == Sight::in_front ? 1 : 0;
    counts.behind += sight == Sight::behind ? 1 : 0;
    const bool off = points.evidence[i] >= kEvidenceDeformed;
    if (sight == Sight::agrees && !off) {
      points.label[i] = points.home[i];
    } else if (off && (sight == Sight::in_front || sight == Sight::agrees || bulged)) {
      points.label[i] = kDeformed;
    } else {
      points.label[i] = kNotObserved;
    }
    if (points.label[i] == kNotObserved) points.match[i] = -1;
  }
  return counts;
}

void carry_homes_to_unseen(const ModelTables& model, PointState& points) noexcept {
  std::size_t head = 0, tail = 0;
  for (std::size_t i = 0; i < model.size; ++i) {
    points.group[i] = points.sight[i] != Sight::none ? 1 : 0;
    if (points.group[i] != 0) points.queue[tail++] = static_cast<std::uint16_t>(i);
  }
  while (head < tail) {
    const std::size_t i = points.queue[head++];
    for (const std::uint16_t n : neighbours_of(model, i)) {
      if (n >= model.size || points.group[n] != 0) continue;
      points.group[n] = 1;
      points.home[n] = points.home[i];
      points.evidence[n] = 0;
      points.queue[tail++] = n;
    }
  }
}

}  // namespace pliant

#include "core/deform/patch_warp.hpp"

#include <algorithm>
#include <cmath>

#include "core/deform/body_tie.hpp"
#include "core/deform/patch_readings.hpp"
#include "core/deform/strain.hpp"
#include "core/track/aside.hpp"
#include "core/track/part_search.hpp"
#include "core/track/steady.hpp"

namespace pliant {

namespace {

/// Of all readings that a patch could have, the share that its region's pull is worth: enough to bring back
/// what nobody sees, too little to hold what a few readings move.
constexpr double kAnchorShare = 0.02;
/// What is left of a spring between two regions: they were told apart because they move as at a joint. Enough
/// to keep patches together that nobody sees.
constexpr double kJointShare = 0.01;

/// What the springs are measured by.
struct Material {
  double noise = 0;   // of a reading, metres
  double strain = 0;  // a border gives by this share of the distance that it bridges,
  double bend = 0;    // or by this angle, where a reading is off by its noise

  [[nodiscard]] double stretch_stiffness(const PatchBorder& border) const noexcept {
    const double give = strain * border.length;
    return border.edges * noise * noise / (give * give);
  }
  [[nodiscard]] double bend_stiffness(const PatchBorder& border) const noexcept {
    return border.edges * noise * noise / (bend * bend);
  }
};

void find_homes(const PatchTables& patches, const PointState& points, PatchWarp& warp) noexcept {
  std::array<std::array<std::uint16_t, limits::kMaxRegions>, kMaxPatches> counts{};
  for (std::size_t i = 0; i < points.home.size(); ++i)
    ++counts[patches.patch_of[i]][static_cast<std::size_t>(points.home[i])];
  for (std::size_t p = 0; p < patches.count; ++p)
    warp.home[p] =
        static_cast<std::int8_t>(std::max_element(counts[p].begin(), counts[p].end()) - counts[p].begin());
}

void add_anchor(const PatchTables& patches, const RigidTransform& region, double limit, std::size_t p,
                PatchWarp& warp) noexcept {
  const RigidTransform& pose = warp.pose[p];
  const Vector3 gap = region * patches.centres[p] - pose * patches.centres[p];
  const double share = warp.held[p] ? kHoldShare : kAnchorShare;
  const double k = share * patches.sizes[p] * giving_way(gap.squaredNorm(), limit);
  const double k_turn = k * 0.5 * patches.radius * patches.radius;
  warp.system.own(p).add_shift_spring(k);
  warp.system.own(p).add_turn_spring(k_turn);
  warp.system.force(p).tail<3>() += k * gap;
  warp.system.force(p).head<3>() += k_turn * turn_between(region.rotation, pose.rotation);
}

/// Joints turn far where the rest of the surface barely bends: bending gives way.
constexpr double kFreeTurn = 0.5;  // radians

void add_borders(const PatchTables& patches, const Material& material, PatchWarp& warp) noexcept {
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    if (warp.system.holds(border.a) && warp.system.holds(border.b)) continue;
    const Vector3 turn = turn_between(warp.pose[border.a].rotation, warp.pose[border.b].rotation);
    PatchMeeting meeting = meeting_of(patches, warp.pose, border.a, border.b, border.centre);
    meeting.link.stretch = material.stretch_stiffness(border);
    meeting.link.bend = material.bend_stiffness(border) * giving_way(turn.squaredNorm(), kFreeTurn);
    if (warp.home[border.a] != warp.home[border.b]) {
      meeting.link.stretch *= kJointShare;
      meeting.link.bend *= kJointShare;
    }
    warp.system.add_link(meeting.link, meeting.gap, turn);
  }
}

/// Across the body, what is seen to be off its region takes along what is not seen. What is seen where its
/// region is says no more than the region's own pull does; between two that are seen, or two of different
/// regions, there is nothing to add, and of two that nobody sees neither knows better.
bool takes_along(const PatchTables& patches, const PatchWarp& warp, const PatchTie& tie) noexcept {
  const auto is_seen = [&](std::size_t p) { return warp.seen[p] >= kFewReadings * patches.sizes[p]; };
  const auto leads = [&](std::size_t p, std::size_t other) {
    return is_seen(p) && !warp.held[p] && !is_seen(other);
  };
  return warp.home[tie.a] == warp.home[tie.b] && (leads(tie.a, tie.b) || leads(tie.b, tie.a));
}

/// What lies between two patches is as stiff as the surface is along itself, each look into the body worth an
/// edge, up to the strain that the material stands: beyond it, it gives way to a dent.
void add_ties(const PatchTables& patches, const Material& material, PatchWarp& warp) noexcept {
  for (std::size_t k = 0; k < patches.tie_count; ++k) {
    const PatchTie& tie = patches.ties[k];
    if (!takes_along(patches, warp, tie)) continue;
    const double give = material.strain * tie.length;
    const double stiffness = tie.looks * material.noise * material.noise / (give * give);
    add_tie(patches, tie, warp.pose, stiffness, give, warp.system);
  }
}

/// Mean squares of a dozen readings differ by half of themselves by chance.
constexpr double kByChance = 1.4;

/// Nearer than this share of that, a patch is where its region is.
constexpr double kAtHome = 0.25;
/// By chance, the six freedoms of a patch lower the sum of its squared residuals by six times σ² where edges,
/// which are not smoothed, hold it; smoothing makes neighbouring readings share their noise, so that a
/// patch's few are worth a fourth: hence four times. What they lower by more pulls a patch away.
constexpr double kByChanceFreely = 24;

/// Patches that the readings put as well where their region is go back there: what slid along the surface
/// unnoticed does not add up over the frames. Not so beside a patch that must be elsewhere: what moves takes
/// its neighbours along, whose readings may not show it. Notes what is seen of every patch; returns those
/// that are off their region or are pulled off it.
ChosenPatches return_home(const PatchLook& look, const RegionSet& regions, const PointState& points,
                          double noise, PatchWarp& warp) noexcept {
  const double smoothed = kSmoothedNoise * noise, near = kAtHome * smoothed,
               much = kByChanceFreely * noise * noise;
  const std::size_t count = look.patches.count;
  std::array<PatchFit, kMaxPatches> here, home;
  ChosenPatches all, astray{};
  all.fill(true);
  measure_fits(look, points, all, much, warp, warp.moments, here);
  home = here;
  const std::array<RigidTransform, kMaxPatches> own = warp.pose;
  for (std::size_t p = 0; p < count; ++p) {
    const RigidTransform& region = regions[static_cast<std::size_t>(warp.home[p])].pose;
    astray[p] = patch_deviation(look.patches, warp, p, region) > near * near;
    warp.pose[p] = region;
  }
  measure_fits(look, points, astray, much, warp, warp.home_moments, home);
  for (std::size_t p = 0; p < count; ++p) {
    const bool as_many = home[p].weight > 0 && home[p].weight >= 0.9 * here[p].weight;
    const bool as_near = home[p].square <= std::max(kByChance * here[p].square, smoothed * smoothed);
    warp.fits[p] = as_many && as_near;
    warp.seen[p] = here[p].weight;
  }
  for (std::size_t p = 0; p < count; ++p) {
    warp.held[p] = warp.fits[p];
    look.patches.neighbours[p].for_each([&](std::size_t q) {
      if (warp.held[p] && warp.home[q] == warp.home[p] && here[q].weight > 0) warp.held[p] = warp.fits[q];
    });
    if (!warp.held[p])
      warp.pose[p] = own[p];
    else if (astray[p])
      warp.moments[p] = warp.home_moments[p];
    const PatchFit& now = warp.held[p] ? home[p] : here[p];
    astray[p] = (astray[p] && !warp.held[p]) || now.pulled;
  }
  return astray;
}

/// Springs carry what moves no farther than this many patches into what stands where its region is: at each
/// the anchors take the larger part.
constexpr int kReachOfSprings = 3;

/// The patches that may move off their regions: those that are off them, what they take along across the
/// body, and what their springs reach.
ChosenPatches moving_patches(const PatchTables& patches, const PatchWarp& warp,
                             const ChosenPatches& astray) noexcept {
  ChosenPatches moving = astray;
  for (std::size_t k = 0; k < patches.tie_count; ++k) {
    const PatchTie& tie = patches.ties[k];
    if ((astray[tie.a] || astray[tie.b]) && takes_along(patches, warp, tie))
      moving[tie.a] = moving[tie.b] = true;
  }
  for (int ring = 0; ring < kReachOfSprings; ++ring) {
    const ChosenPatches inner = moving;
    for (std::size_t k = 0; k < patches.border_count; ++k) {
      const PatchBorder& border = patches.borders[k];
      if (inner[border.a] || inner[border.b]) moving[border.a] = moving[border.b] = true;
    }
  }
  return moving;
}

/// Share of a reading's noise by which every freedom of every patch may still be off its balance: the noise
/// that is left in a patch after a dozen smoothed readings is twice that.
constexpr double kNothing = 0.05;

/// A patch that a round moved by less than this share of the noise, what is left of it in a pose, has come to
/// rest for this frame.
constexpr double kAtRest = kNoiseOfPose;

int aside_step(const Projector& projector, const ReadingGates& gates, std::int32_t z) noexcept {
  return std::max(1, projector.pixels(gates.inward, z) / kLooksAside);
}

/// One balance of readings, anchors and springs of the patches that still move; those that came to rest do
/// so no more. No patch turns by more than kFreeTurn or moves farther than readings lie off it: for what is
/// far out of balance, the equations, which are linear, do not hold that far. False when there is no balance.
bool balance(const PatchLook& look, const RegionSet& regions, ChosenPatches& moving, const Material& material,
             double limit, int iterations, PatchWarp& warp) noexcept {
  const std::size_t count = look.patches.count;
  warp.system.clear(count);
  std::size_t moving_count = 0;
  for (std::size_t p = 0; p < count; ++p) {
    if (!moving[p]) {
      warp.system.hold(p);
      continue;
    }
    ++moving_count;
    add_readings(warp.moments[p], warp.system.own(p), warp.system.force(p));
    warp.seen[p] = static_cast<double>(warp.moments[p].weight) / 256;
    add_anchor(look.patches, regions[static_cast<std::size_t>(warp.home[p])].pose, limit, p, warp);
  }
  add_borders(look.patches, material, warp);
  add_ties(look.patches, material, warp);
  const double still = kNothing * material.noise, farthest = look.gates.inward / kUnitsPerMetre;
  if (!warp.system.solve(iterations, 6 * still * still * static_cast<double>(moving_count))) return false;
  for (std::size_t p = 0; p < count; ++p) {
    const Vector6& x = warp.system.motion(p);
    if (!moving[p]) continue;
    const double turn = x.head<3>().norm(), shift = x.tail<3>().norm();
    const bool sound = std::isfinite(turn + shift);
    const double share = std::min({1.0, kFreeTurn / turn, farthest / shift});
    if (sound) warp.pose[p] = motion_about(share * x, warp.pose[p] * look.patches.centres[p]) * warp.pose[p];
    const double radius = 0.5 * look.patches.radius, rest = kAtRest * material.noise;
    moving[p] =
        sound && x.tail<3>().squaredNorm() + x.head<3>().squaredNorm() * radius * radius > rest * rest;
  }
  return true;
}

/// Which patches stand, with all their neighbours, exactly where one region puts them: no point of theirs is
/// off it.
void find_rigid(const PatchTables& patches, const RegionSet& regions, PatchWarp& warp) noexcept {
  const auto stands = [&](std::size_t p) {
    const RigidTransform& region = regions[static_cast<std::size_t>(warp.home[p])].pose;
    return warp.pose[p].rotation == region.rotation && warp.pose[p].translation == region.translation;
  };
  const bool complete = patches.border_count < kMaxBorders;
  for (std::size_t p = 0; p < patches.count; ++p) warp.rigid[p] = complete && stands(p);
  const std::array<bool, kMaxPatches> alone = warp.rigid;
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    const bool one = warp.home[border.a] == warp.home[border.b];
    if (!one || !alone[border.b]) warp.rigid[border.a] = false;
    if (!one || !alone[border.a]) warp.rigid[border.b] = false;
  }
}

}  // namespace

void warp_patches(const ModelTables& model, const PatchTables& patches, const Surface& surface,
                  const Projector& projector, const Tolerance& tolerance, const RegionSet& regions,
                  const WarpSettings& settings, const PointState& points, PatchWarp& warp) noexcept {
  find_homes(patches, points, warp);
  std::array<RigidTransform, limits::kMaxRegions> step;
  for (std::size_t k = 0; k < regions.size(); ++k)
    if (regions[k].alive) step[k] = regions[k].pose * regions[k].last_pose.inverse();
  for (std::size_t p = 0; p < patches.count; ++p) {
    warp.pose[p] = step[static_cast<std::size_t>(warp.home[p])] * warp.pose[p];
    warp.pose[p].rotation = orthonormalised(warp.pose[p].rotation);
  }
  const std::int32_t z = depth_of(regions[0].pose, model.centre);
  const double noise = surface.sigma(z) / kUnitsPerMetre, limit = tolerance.deformed(z) / kUnitsPerMetre;
  const Material material{noise, strain_limit(settings.material), bend_limit(settings.material)};
  PatchLook look{model, patches, surface, projector, {}, 1};
  ReadingGates& gates = look.gates;
  gates = {std::min(settings.inward, kFarthestReading), std::min(settings.outward, kFarthestReading),
           surface.pixel_span(model.spacing / kUnitsPerMetre)};
  look.step = aside_step(projector, gates, z);
  const std::array<RigidTransform, kMaxPatches> before = warp.pose;
  const ChosenPatches astray = return_home(look, regions, points, noise, warp);
  const ChosenPatches moving = moving_patches(patches, warp, astray);
  ChosenPatches active = moving;
  for (int round = 0; round < settings.rounds; ++round) {
    if (round > 0) {
      gates.narrow(2 * tolerance.deformed(z));
      look.step = aside_step(projector, gates, z);
      gather_readings(look, points, active, warp);
    }
    if (!balance(look, regions, active, material, limit, settings.iterations, warp)) break;
  }
  for (std::size_t p = 0; p < patches.count; ++p)
    if (moving[p])
      warp.pose[p] = steadied(before[p], warp.pose[p], patches.centres[p], 0.5 * patches.radius,
                              kNoiseOfPose * noise, warp.steps[p], least_share(points.frames));
    else
      warp.steps[p] = StepMemory();
  find_rigid(patches, regions, warp);
  ChosenPatches all;
  all.fill(true);
  place_patches(model, patches, all, warp);
}

}  // namespace pliant

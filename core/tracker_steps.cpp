#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/deform/radius_search.hpp"
#include "core/track/align.hpp"
#include "core/track/associate.hpp"
#include "core/track/borders.hpp"
#include "core/track/joints.hpp"
#include "core/track/narrowing.hpp"
#include "core/track/predict.hpp"
#include "core/track/regain_hold.hpp"
#include "core/track/steady.hpp"
#include "core/track/strays.hpp"
#include "core/track/undecided.hpp"
#include "core/tracker_state.hpp"

namespace pliant {

namespace {

constexpr std::int32_t kReach = 40 * kUnitsPerMillimetre;  // room in the window: 1.2 m/s at 30 Hz
constexpr std::int32_t kMotionGate =
    24 * kUnitsPerMillimetre;  // how far off its prediction a point is looked for
constexpr std::uint32_t kFewestAgreeing = 40;

void finish_stage(const TrackerState& s, Stage stage) noexcept {
  if (s.observer.stage_done != nullptr) s.observer.stage_done(s.observer.context, stage);
}

std::size_t share_of_points(const TrackerState& s, double share) noexcept {
  const auto size =
      static_cast<std::size_t>(share * (0.25 + 0.75 * s.work_level) * static_cast<double>(s.tables.size));
  return std::min(std::max<std::size_t>(size, 400), s.tables.size);
}

std::uint32_t fewest_region_points(const TrackerState& s) noexcept {
  return std::max<std::uint32_t>(48, static_cast<std::uint32_t>(s.tables.size / 100));
}

/// One round of association and alignment.
AlignSteps round_of_alignment(TrackerState& s, const SearchReaches& reaches,
                              AlignSettings settings) noexcept {
  associate(s.tables, s.surface, s.projector, s.regions, reaches, s.points);
  finish_stage(s, Stage::associate);
  settings.half_radius = 0.5 * s.tables.model->radius();
  settings.robust = s.settings.steps.robust_weights;
  const AlignSteps steps =
      align(s.surface, settings, find_joints(s.patches, s.warp, s.regions), s.points, s.regions);
  finish_stage(s, Stage::align);
  return steps;
}

/// The inlier test's limit at the base region's depth.
std::int32_t inlier_limit(const TrackerState& s) noexcept {
  return s.tolerance.deformed(depth_of(s.regions[0].pose, s.tables.centre));
}

void count_regions(TrackerState& s) noexcept {
  for (TrackedRegion& region : s.regions) region.points = 0;
  std::array<std::int64_t, limits::kMaxRegions> squares{};
  for (std::size_t i = 0; i < s.tables.size; ++i) {
    if (s.points.label[i] < 0) continue;
    const auto k = static_cast<std::size_t>(s.points.label[i]);
    ++s.regions[k].points;
    squares[k] += static_cast<std::int64_t>(s.points.residual[i]) * s.points.residual[i];
  }
  for (std::size_t k = 0; k < s.regions.size(); ++k) {
    TrackedRegion& region = s.regions[k];
    if (!region.alive) continue;
    if (region.points > 0)
      region.rms = std::sqrt(static_cast<double>(squares[k]) / region.points) / kUnitsPerMetre;
    region.frames_unseen = region.points >= kFewestCorrespondences ? 0 : region.frames_unseen + 1;
  }
}

}  // namespace

void observe_surface(TrackerState& s, const DepthFrame& frame) noexcept {
  s.surface.build(frame, predicted_window(s.tables, s.projector, s.points, s.regions,
                                          kReach + s.tables.spacing * 4, s.camera.width, s.camera.height));
}

void predict_regions(TrackerState& s) noexcept {
  predict(s.regions);
}

void align_regions(TrackerState& s) noexcept {
  choose_still_or_moving(s.tables, s.surface, s.projector, s.points, 512, s.regions);
  finish_stage(s, Stage::predict);
  // Last rounds trust only what fits well within what the inlier test will call rigid: a part that moved on,
  // or a bend, must not drag the rest.
  const std::int32_t inlier = inlier_limit(s);
  const SearchWidths widths = {{{{share_of_points(s, 0.25), kMotionGate}, kMotionGate},
                                {{share_of_points(s, 0.25), kMotionGate}, 2 * inlier},
                                {{share_of_points(s, 0.5), 3 * inlier}, inlier},
                                {{share_of_points(s, 1.0), 3 * inlier}, inlier / 2}}};
  const double sigma = s.surface.sigma(depth_of(s.regions[0].pose, s.tables.centre)) / kUnitsPerMetre;
  Narrowing narrowing(widths, sigma, s.regions);
  for (int round = 0; round < kMostRounds && !narrowing.at_rest(); ++round) {
    AlignSettings settings;
    settings.widest = narrowing.widest();
    narrowing.go_on(round_of_alignment(s, narrowing.reaches(), settings));
  }
  hold_steady(s.tables, s.surface, s.points.frames, s.regions);
  for (TrackedRegion& region : s.regions)
    if (region.alive) region.motion = region.pose * region.last_pose.inverse();
}

void warp_surface(TrackerState& s) noexcept {
  WarpSettings settings;
  settings.rounds = 1 + static_cast<int>(s.work_level + 0.5);
  settings.material = s.settings.material;
  settings.inward = kMotionGate;
  settings.outward = kMotionGate / 2;  // a finger stands before the surface, a dent never does
  warp_patches(s.tables, s.patches, s.surface, s.projector, s.tolerance, s.regions, settings, s.points,
               s.warp);
}

void regain_base(TrackerState& s) noexcept {
  regain_hold(s.tables, s.patches, s.warp, s.tolerance, s.regions[0], s.points);
}

void label_points(TrackerState& s) noexcept {
  recall_strays(s.patches, s.warp, s.points);
  const Sighting sighting(s.tables, s.surface, s.projector, s.tolerance);
  const RegionBorders borders = region_borders(s.patches, s.points.home);
  settle_undecided(s.tables, s.patches, borders, sighting, s.regions, s.points);
  s.counts = label({s.tables, s.patches, s.warp, s.surface, s.projector, s.tolerance, borders,
                    s.settings.steps.temporal_evidence},
                   s.regions, s.points);
}

void regroup_outliers(TrackerState& s) noexcept {
  RegroupSettings settings;
  settings.max_regions = s.settings.max_regions;
  settings.fewest_points = fewest_region_points(s);
  const Sighting sighting(s.tables, s.surface, s.projector, s.tolerance);
  if (s.settings.steps.merge_and_split && regroup({s.tables, s.patches, s.warp, sighting, s.tolerance},
                                                  settings, s.regroup_state, s.regions, s.points))
    carry_homes_to_unseen(s.tables, s.points);
  count_regions(s);
  for (TrackedRegion& region : s.regions) {
    if (!region.alive || region.parent < 0) continue;
    const TrackedRegion& parent = s.regions[static_cast<std::size_t>(region.parent)];
    if (region.frames_unseen == 0)
      region.from_parent = parent.pose.inverse() * region.pose;
    else
      region.pose = parent.pose * region.from_parent;
  }
}

void match_deformed(TrackerState& s) noexcept {
  search_deformed(s.tables, s.surface, s.projector, kSearchLimits * inlier_limit(s), s.taken_pixels,
                  s.points);
}

void weigh_strain(TrackerState& s) noexcept {
  s.strain = measure_strain(s.patches, s.warp, s.settings.material);
}

bool judge(TrackerState& s) noexcept {
  std::uint32_t agree = 0, deformed_matched = 0, seen_through = 0;
  for (std::size_t i = 0; i < s.tables.size; ++i) {
    const bool matched = s.points.match[i] >= 0;
    agree += s.points.label[i] >= 0 ? 1U : 0U;
    deformed_matched += s.points.label[i] == kDeformed && matched ? 1U : 0U;
    seen_through += s.points.sight[i] == Sight::in_front && !matched ? 1U : 0U;
  }
  const std::uint32_t hidden = s.counts.behind;
  const double explained = agree + 0.5 * deformed_matched;
  const double total = explained + 0.5 * deformed_matched + seen_through + 0.25 * hidden;
  // What the material cannot be stretched to is no shape of the object, however well it fits.
  s.confidence = total > 0 ? explained / total * (1 - s.strain.overstrained) : 0;
  const std::uint32_t fewest = std::max(kFewestAgreeing, s.counts.facing / 16);
  return agree >= fewest && s.confidence >= 0.4 && seen_through <= agree + deformed_matched / 2;
}

void remember_last_frame(TrackerState& s) noexcept {
  s.last_frame.regions = s.regions;
  s.last_frame.patches = s.warp.pose;
  s.last_frame.patch_steps = s.warp.steps;
  s.last_frame.regroup = s.regroup_state;
  s.last_frame.points.keep(s.points);
}

void return_to_last_frame(TrackerState& s) noexcept {
  s.regions = s.last_frame.regions;
  s.warp.pose = s.last_frame.patches;
  s.warp.steps = s.last_frame.patch_steps;
  s.regroup_state = s.last_frame.regroup;
  s.last_frame.points.give_back(s.points);
}

void take_up(TrackerState& s, const RigidTransform& pose) noexcept {
  s.points.reset();
  s.regions = RegionSet();
  s.regroup_state = RegroupState();
  TrackedRegion& base = s.regions[0];
  base.alive = true;
  base.pose = base.last_pose = base.predicted = pose;
  s.warp.reset(pose);
}

bool acquire(TrackerState& s, const DepthFrame& frame, const RigidTransform& pose) noexcept {
  take_up(s, pose);
  TrackedRegion& base = s.regions[0];
  s.surface.build(frame, predicted_window(s.tables, s.projector, s.points, s.regions,
                                          kReach + s.tables.spacing * 4, s.camera.width, s.camera.height));
  AlignSettings
      settings;  // a detection is good to a few degrees and centimetres; the object may have moved since
  settings.prior_rotation = 0.2;
  settings.prior_translation = 0.04;
  std::int32_t gate = kReach;
  for (int round = 0; round < 10; ++round) {
    settings.widest = for_every_region(gate);
    (void)round_of_alignment(s, for_every_region(SearchReach{share_of_points(s, 0.5), gate}), settings);
    gate = std::max(gate * 3 / 4, 2 * inlier_limit(s));
  }
  base.motion = RigidTransform();
  base.last_pose = base.pose;
  s.warp.reset(base.pose);
  warp_surface(s);
  regain_base(s);
  label_points(s);
  count_regions(s);
  match_deformed(s);
  weigh_strain(s);
  return judge(s);
}

void publish_tracked(TrackerState& s) noexcept {
  TrackResult& r = s.result;
  s.was_tracked = true;
  r.state = TrackState::tracking;
  r.confidence = static_cast<float>(s.confidence);
  r.pose = s.regions[0].pose;
  std::size_t count = 0;
  for (std::size_t k = 0; k < s.regions.size(); ++k) {
    const TrackedRegion& region = s.regions[k];
    if (!region.alive || region.points == 0) continue;
    Vector3 joint;
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    Point3f joint_now{kNone, kNone, kNone};
    if (region.parent >= 0 &&
        find_joint(s.patches, s.warp, static_cast<std::int8_t>(k), region.parent, joint)) {
      joint = region.pose * joint;
      joint_now = to_point(joint);
    }
    s.published[count++] = {
        static_cast<std::int8_t>(k),
        region.parent,
        region.points,
        static_cast<float>(region.rms),
        static_cast<float>(std::min(1.0, 4.0 * region.points / std::max(1U, s.counts.facing))),
        region.pose,
        joint_now};
  }
  constexpr float kMetres = static_cast<float>(1 / kUnitsPerMetre);
  for (std::size_t i = 0; i < s.tables.size; ++i) {
    const IntPoint& p = s.points.position[i];
    s.positions[i] = {static_cast<float>(p.x) * kMetres, static_cast<float>(p.y) * kMetres,
                      static_cast<float>(p.z) * kMetres};
    s.residuals[i] =
        s.points.match[i] < 0 ? 0.0F : static_cast<float>(std::abs(s.points.residual[i])) * kMetres;
    s.strains[i] = s.points.label[i] == kDeformed ? strain_at(s.patches, s.strain, i) : 0.0F;
  }
  r.regions = {s.published.data(), count};
  r.positions = s.positions;
  r.labels = s.points.label;
  r.matches = s.points.match;
  r.residuals = s.residuals;
  r.strains = s.strains;
  r.strain_energy = static_cast<float>(s.strain.energy);
}

}  // namespace pliant

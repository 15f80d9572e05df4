#include "core/registration/cloud_warp.hpp"

#include <algorithm>

#include "core/deform/body_tie.hpp"
#include "core/detect/fast_transform.hpp"
#include "core/registration/chain_measures.hpp"
#include "core/registration/warp_readings.hpp"
#include "core/registration/warp_starts.hpp"

namespace pliant {

namespace {

constexpr double kFirstGate = 0.25, kLastSpacings = 2.5;  // of the model's radius; of the spacing
constexpr double kHold = 1.0;  // of a patch's points: what its region's pull is worth where it explains it

/// Across the body, what the scene shows takes along what it does not, up to the strain that the material
/// stands, as the tracker's warp does. `stiffness`: of a look one metre long.
void add_ties(Warp& w, double stiffness, double strain) noexcept {
  const PatchTables& patches = w.room.patches;
  const auto is_seen = [&](std::size_t p) {
    return w.room.rigid[p] || w.room.readings[p] >= kFewReadings * patches.sizes[p];
  };
  for (std::size_t k = 0; k < patches.tie_count; ++k) {
    const PatchTie& tie = patches.ties[k];
    if (is_seen(tie.a) == is_seen(tie.b)) continue;
    add_tie(patches, tie, w.room.pose, tie.looks * stiffness / (tie.length * tie.length), strain * tie.length,
            w.room.system);
  }
}

void add_springs(Warp& w, double stretch, double bend) noexcept {
  const PatchTables& patches = w.room.patches;
  for (std::size_t p = 0; p < patches.count; ++p) {
    const RigidTransform& region = w.buffers.regions[static_cast<std::size_t>(w.room.home[p])].transform;
    // A whole patch of a region stays; of another, what the region explains pulls it there.
    const double k = w.room.rigid[p] ? 100.0 * patches.sizes[p] : kHold * w.room.hold[p];
    if (k <= 0) continue;
    w.room.system.own(p).add_shift_spring(k);
    w.room.system.own(p).add_turn_spring(0.5 * k * patches.radius * patches.radius);
    w.room.system.force(p).tail<3>() +=
        k * (region * patches.centres[p] - w.room.pose[p] * patches.centres[p]);
    w.room.system.force(p).head<3>() +=
        0.5 * k * patches.radius * patches.radius * turn_between(region.rotation, w.room.pose[p].rotation);
  }
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    if (w.room.rigid[border.a] && w.room.rigid[border.b]) continue;
    PatchMeeting meeting = meeting_of(patches, w.room.pose, border.a, border.b, border.centre);
    meeting.link.stretch = stretch * border.edges;
    meeting.link.bend = bend * border.edges;
    w.room.system.add_link(meeting.link, meeting.gap,
                           turn_between(w.room.pose[border.a].rotation, w.room.pose[border.b].rotation));
  }
}

}  // namespace

void warp_cloud(RegistrationState& s, const CloudWarpSettings& settings, InstanceBuffers& buffers) noexcept {
  Warp w{s, buffers, s.warp};
  find_homes(w);
  const std::size_t pulls = find_pulls(w);
  std::size_t free_count = place_free(w);
  const double first = kFirstGate * s.model.radius(), last = kLastSpacings * s.spacing;
  if (free_count > 0) {
    const std::size_t targets = near_scene(w, free_count, 2 * first);
    s.work += s.base_count * work::kNearest;
    static_cast<void>(w.room.target_grid.build(w.room.targets.first(targets), 2 * s.spacing));
    // A border edge gives by `strain` of its length, or bends by that angle, where a reading is off by a
    // quarter of the spacing: what sampling leaves.
    const double noise = 0.25 * s.spacing, strain = 0.1 + 0.4 * s.model.material();
    const double stretch = noise * noise / (strain * strain * s.model.spacing() * s.model.spacing());
    const double bend = noise * noise / (strain * strain);
    for (int round = 0; round < settings.rounds; ++round) {
      // From stiff, which brings large pieces near, to soft.
      const double done = static_cast<double>(round) / std::max(1, settings.rounds - 1);
      const double gate = first + (last - first) * std::min(1.0, 1.3 * done);
      const double stiff = 1 + 15 * (1 - done) * (1 - done);
      w.room.system.clear(w.room.patches.count);
      add_readings(w, free_count, targets, gate);
      s.work += (free_count + targets) * work::kReading;
      // What descriptors say is good to a keypoint's distance.
      if (done < 0.7) add_pulls(w, pulls, 4 * (1 - done), 2 * first * (1 - done) + 2 * match_tolerance(s));
      add_springs(w, stiff * stretch, stiff * bend);
      add_ties(w, stiff * bend, strain);
      if (!w.room.system.solve(settings.iterations)) break;
      for (std::size_t p = 0; p < w.room.patches.count; ++p) {
        const Vector6& x = w.room.system.motion(p);
        if (w.room.rigid[p] || !(x.squaredNorm() < 1.0)) continue;  // also for not-a-number
        w.room.pose[p] = motion_about(x, w.room.pose[p] * w.room.patches.centres[p]) * w.room.pose[p];
        w.room.pose[p].rotation = orthonormalised(w.room.pose[p].rotation);
      }
      free_count = place_free(w);
    }
  }
  for (std::size_t p = 0; p < w.room.patches.count; ++p) w.room.fast[p] = FastTransform(w.room.pose[p]);
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    if (buffers.labels[i] >= 0) {
      const RigidTransform& region = buffers.regions[static_cast<std::size_t>(buffers.labels[i])].transform;
      buffers.positions[i] = FastTransform(region).point(s.model.positions()[i]);
      continue;
    }
    const PointBlend& blend = w.room.patches.blend[i];
    Point3f sum;
    for (std::size_t j = 0; j < 4 && blend.weight[j] != 0; ++j) {
      const Point3f p = w.room.fast[blend.patch[j]].point(s.model.positions()[i]);
      const float weight = static_cast<float>(blend.weight[j]) / (1 << PointBlend::kShift);
      sum = {sum.x + weight * p.x, sum.y + weight * p.y, sum.z + weight * p.z};
    }
    buffers.positions[i] = sum;
  }
}

}  // namespace pliant

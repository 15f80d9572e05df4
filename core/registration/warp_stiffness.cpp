#include "core/registration/warp_stiffness.hpp"

#include <algorithm>

namespace pliant {

namespace {

constexpr double kTorn = 0.2;  // of a patch's radius
constexpr double kBent = 0.5;  // radians
constexpr int kIterations = 24;

}  // namespace

WarpStiffness stiffness_of(const RegistrationState& s) noexcept {
  const double noise = 0.25 * s.spacing, strain = 0.1 + 0.4 * s.model.material();
  const double bend = noise * noise / (strain * strain);
  return {bend / (s.model.spacing() * s.model.spacing()), bend, strain};
}

void add_springs(WarpRoom& room, const WarpStiffness& stiffness, const WarpHold& hold) noexcept {
  const PatchTables& patches = room.patches;
  const double torn = hold.limit * kTorn * patches.radius, bent = hold.limit * kBent;
  for (std::size_t k = 0; k < patches.border_count; ++k) {
    const PatchBorder& border = patches.borders[k];
    const std::size_t a = border.a, b = border.b;
    if (room.system.holds(a) && room.system.holds(b)) continue;
    const bool joint = hold.limb != nullptr && hold.limb->has(a) != hold.limb->has(b);
    if (joint && !room.settled[a] && !room.settled[b]) continue;
    PatchMeeting meeting = meeting_of(patches, room.pose, border.a, border.b, border.centre);
    const Vector3 turn = turn_between(room.pose[a].rotation, room.pose[b].rotation);
    const double edges = hold.share * border.edges;
    meeting.link.stretch = edges * stiffness.stretch / (1 + meeting.gap.squaredNorm() / (torn * torn));
    meeting.link.bend = joint ? 0 : edges * stiffness.bend / (1 + turn.squaredNorm() / (bent * bent));
    const bool led = (room.active[a] || room.fixed[a]) && (room.active[b] || room.fixed[b]);
    if (hold.limb == nullptr && !led) meeting.link.bend *= hold.following;
    room.system.add_link(meeting.link, meeting.gap, turn);
  }
}

double move_patches(WarpRoom& room) noexcept {
  if (!room.system.solve(kIterations)) return -1;
  double farthest = 0;
  for (std::size_t p = 0; p < room.patches.count; ++p) {
    const Vector6& x = room.system.motion(p);
    if (room.system.holds(p) || !(x.squaredNorm() < 1.0)) continue;  // also for not-a-number
    room.pose[p] = motion_about(x, room.pose[p] * room.patches.centres[p]) * room.pose[p];
    room.pose[p].rotation = orthonormalised(room.pose[p].rotation);
    farthest = std::max(farthest, x.tail<3>().norm() + room.patches.radius * x.head<3>().norm());
  }
  return farthest;
}

}  // namespace pliant

#include "core/registration/warp_growth.hpp"

#include <algorithm>

#include "core/deform/body_tie.hpp"
#include "core/registration/limb_turns.hpp"

namespace pliant {

namespace {

constexpr double kStarts = 0.6;      // of a patch's samples, shown where a region puts it: it starts settled
constexpr double kSettles = 0.6;     // where the warp put it
constexpr std::uint32_t kBorne = 3;  // matches
constexpr double kLoosens = 0.4;     // fewer: it is not any more
// A region of interleaved points has slid through something of a like shape: of a true one, most points lie
// in patches that are nearly all its own.
constexpr double kOwnPatch = 0.75, kTrusted = 0.8;
// A patch beside a settled one is off by no more than it is wide.
constexpr double kWide = 2;                       // of a patch's radius
constexpr double kWidest = 4, kNarrow = 2.5;      // of the spacing
constexpr double kSoft = 0.3;                     // of the stiffness, while patches settle
constexpr double kFollowing = 20;                 // times the stiffness of what only follows
constexpr double kVerySoft = 0.02, kFarther = 5;  // while it relaxes
constexpr double kAtRest = 0.05;                  // of the spacing: a fifth of what sampling leaves
constexpr int kRounds = 40, kStill = 3, kMostTurns = 6, kRelaxRounds = 30;

PatchSet all_of(const PatchTables& patches) noexcept {
  PatchSet all;
  for (std::size_t p = 0; p < patches.count; ++p) all.add(p);
  return all;
}

std::array<bool, limits::kMaxRegions> trusted_regions(const WarpRoom& room) noexcept {
  std::array<bool, limits::kMaxRegions> trusted{};
  for (std::size_t r = 0; r < trusted.size(); ++r) {
    double all = 0, own = 0;
    for (std::size_t p = 0; p < room.patches.count; ++p) {
      const double points = room.counts[p][r];
      all += points;
      if (points >= kOwnPatch * room.patches.sizes[p]) own += points;
    }
    trusted[r] = r == 0 || own >= kTrusted * all;
  }
  return trusted;
}

/// Whether a settled patch beside `p` puts the border between them where `p` does.
bool hangs_on_settled(const WarpRoom& room, std::size_t p) noexcept {
  const double square = room.patches.radius * room.patches.radius;
  for (std::size_t k = 0; k < room.patches.border_count; ++k) {
    const PatchBorder& border = room.patches.borders[k];
    if (border.a != p && border.b != p) continue;
    if (!room.settled[border.a == p ? border.b : border.a]) continue;
    if ((room.pose[border.a] * border.centre - room.pose[border.b] * border.centre).squaredNorm() < square)
      return true;
  }
  return false;
}

/// What regions explain is settled where the scene says so; so is what lies within a region, where the
/// scene's normals may be wrong, and what matches bear out if it hangs on the rest: alone, it may have slid
/// along something of a like shape.
void start(WarpSamples& samples) noexcept {
  WarpRoom& room = samples.room();
  const PatchTables& patches = room.patches;
  samples.place();
  samples.find_facing(all_of(patches));
  const auto trusted = trusted_regions(room);
  std::array<bool, kMaxPatches> borne{};
  for (std::size_t p = 0; p < patches.count; ++p) {
    const bool explained = room.rigid[p] || 2 * room.hold[p] >= patches.sizes[p];
    const bool shown = room.asked[p] > 0 && room.close[p] >= kStarts * room.asked[p];
    bool within = room.rigid[p];
    patches.neighbours[p].for_each(
        [&](std::size_t q) { within = within && room.rigid[q] && room.home[q] == room.home[p]; });
    const bool believed = trusted[static_cast<std::size_t>(room.home[p])];
    room.settled[p] = ((explained && shown) || within) && believed;
    room.fixed[p] = room.rigid[p] && room.settled[p];
    borne[p] = !room.settled[p] && shown && room.borne[p] >= kBorne;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t p = 0; p < patches.count; ++p) {
      if (!borne[p] || !hangs_on_settled(room, p)) continue;
      room.settled[p] = changed = true;
      borne[p] = false;
    }
  }
  for (std::size_t p = 0; p < patches.count; ++p)
    if (borne[p])
      room.pose[p] = samples.warp().buffers.regions[static_cast<std::size_t>(room.home[p])].transform;
}

void activate(WarpRoom& room) noexcept {
  const PatchTables& patches = room.patches;
  for (std::size_t p = 0; p < patches.count; ++p) {
    float facing = 0;
    bool beside = false;
    patches.neighbours[p].for_each([&](std::size_t q) {
      beside = beside || room.settled[q];
      facing += room.settled[q] ? room.facing[q] : 0;
    });
    room.active[p] = !room.fixed[p] && (room.settled[p] || beside);
    if (room.active[p] && !room.settled[p]) room.facing[p] = facing < 0 ? -1.0F : 1.0F;
  }
}

/// Readings of the active patches: from farther off while they are not settled.
void read(WarpSamples& samples) noexcept {
  WarpRoom& room = samples.room();
  const double spacing = samples.warp().s.spacing;
  const double wide = std::max(kWide * room.patches.radius, kWidest * spacing), narrow = kNarrow * spacing;
  room.system.clear(room.patches.count);
  for (std::size_t p = 0; p < room.patches.count; ++p)
    if (room.fixed[p]) room.system.hold(p);
  for (std::size_t k = 0; k < samples.count(); ++k) {
    const std::size_t p = samples.patch_of(k);
    if (!room.active[p]) continue;
    const WarpSamples::Placed sample = {room.places[k], room.normals[k]};
    const double gate = room.settled[p] ? narrow : wide;
    float square = 0;
    const std::uint32_t target =
        samples.target_of(sample, gate, WarpSamples::kAlike, room.facing[p], square,
                          [&](std::uint8_t owner) noexcept { return room.near[p].has(owner); });
    if (target == PointGrid::kNone) continue;
    add_reading(samples, sample.at, target, square, gate, room.pose[p] * room.patches.centres[p],
                room.system.own(p), room.system.force(p));
  }
  samples.warp().s.work += samples.count() * work::kReading;
}

/// Across the body, what is settled takes along what is not, up to the strain that the material stands.
void add_ties(WarpRoom& room, const WarpStiffness& stiffness) noexcept {
  for (std::size_t k = 0; k < room.patches.tie_count; ++k) {
    const PatchTie& tie = room.patches.ties[k];
    if (room.settled[tie.a] == room.settled[tie.b]) continue;
    add_tie(room.patches, tie, room.pose, tie.looks * stiffness.bend / (tie.length * tie.length),
            stiffness.strain * tie.length, room.system);
  }
}

/// Returns how many are settled.
std::size_t settle(WarpSamples& samples) noexcept {
  WarpRoom& room = samples.room();
  samples.place();
  samples.count_close();
  std::size_t settled = 0;
  for (std::size_t p = 0; p < room.patches.count; ++p) {
    const double least = (room.settled[p] ? kLoosens : kSettles) * room.asked[p];
    if (!room.fixed[p]) room.settled[p] = room.active[p] && room.asked[p] > 0 && room.close[p] >= least;
    settled += room.settled[p] ? 1U : 0U;
  }
  return settled;
}

}  // namespace

void grow_settled(WarpSamples& samples, const WarpStiffness& stiffness) noexcept {
  WarpRoom& room = samples.room();
  LimbMemory memory;
  start(samples);
  std::size_t most = 0;
  int still = 0, turns = 0;
  for (int round = 0; round < kRounds; ++round) {
    samples.place();
    samples.find_owners();
    activate(room);
    read(samples);
    add_springs(room, stiffness, {.share = kSoft, .following = kFollowing});
    add_ties(room, stiffness);
    if (move_patches(room) < 0) return;
    const std::size_t settled = settle(samples);
    still = settled > most ? 0 : still + 1;
    most = std::max(most, settled);
    if (still < kStill) continue;
    // From one place, what is hidden would be taken for a limb that went elsewhere.
    if (settled == room.patches.count || samples.warp().s.one_view || turns++ == kMostTurns) return;
    samples.find_owners();
    if (!turn_limbs(samples, stiffness, memory)) return;
    most = 0;
    still = 0;
  }
}

void relax_settled(WarpSamples& samples, const WarpStiffness& stiffness) noexcept {
  WarpRoom& room = samples.room();
  // At its borders, a region's explanation is chance as often as not.
  const std::array<bool, kMaxPatches> fixed = room.fixed;
  for (std::size_t p = 0; p < room.patches.count; ++p)
    room.patches.neighbours[p].for_each([&](std::size_t q) { room.fixed[p] = room.fixed[p] && fixed[q]; });
  for (int round = 0; round < kRelaxRounds; ++round) {
    samples.place();
    samples.find_owners();
    for (std::size_t p = 0; p < room.patches.count; ++p) room.active[p] = !room.fixed[p] && room.settled[p];
    read(samples);
    add_springs(room, stiffness, {.share = kVerySoft, .limit = kFarther, .following = kFollowing});
    if (move_patches(room) < kAtRest * samples.warp().s.spacing) return;  // or singular
  }
}

}  // namespace pliant

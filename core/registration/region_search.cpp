#include "core/registration/region_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/registration/chain_measures.hpp"
#include "core/registration/surface_joints.hpp"

namespace pliant {

namespace {

constexpr double kLittleTurn = 0.87;           // cosine of 30°
constexpr std::uint32_t kJoined = 0x3FFFFFFF;  // in place of a piece's size: large, and looked at
constexpr std::uint32_t kFewMatches = 20;      // too few to tell a share from
constexpr std::uint32_t kFewestAgree = 3;
constexpr double kAgreeShare = 0.035;
constexpr float kDoubtful = 0.3F;  // of what a point may be off its region: more than chance

/// Open model points, the first `most` in the model's order (evenly spread), to s.part.
std::size_t open_part(RegistrationState& s, std::size_t most) noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < s.model.size() && count < most; ++i)
    if (s.open[i] != 0) s.part[count++] = static_cast<std::uint16_t>(i);
  return count;
}

/// Points of the largest connected piece of the open ones, at most the first `most`, to s.part.
std::size_t largest_open_piece(RegistrationState& s, std::size_t most) noexcept {
  std::uint32_t size = 0;
  const std::uint32_t piece = s.islands.pieces(
      s.model, [&](std::size_t i) { return s.open[i] != 0; }, size);
  std::size_t count = 0;
  for (std::size_t i = 0; i < s.model.size() && count < most; ++i)
    if (piece != 0 && s.islands.piece()[i] == piece) s.part[count++] = static_cast<std::uint16_t>(i);
  return count;
}

struct Gain {
  std::uint32_t points = 0;  // of the largest connected piece
  std::uint32_t piece = 0;
};

/// Whether the descriptors bear a pose of the piece `piece` of s.islands out: of its matches, it explains
/// more than chance would. A piece can slide along something of a like shape, and fits it closely, but its
/// matches say otherwise: of a false pose's, up to 2 % are explained, of a right one's 5 % and more.
bool borne_out(const RegistrationState& s, std::uint32_t piece, const RigidTransform& pose) noexcept {
  const double limit = 2 * match_tolerance(s);
  std::uint32_t matches = 0, agree = 0;
  for (std::size_t k = 0; k < s.posed_count; ++k) {
    if (s.islands.piece()[s.matches[k].model] != piece) continue;
    ++matches;
    const Vector3 gap = pose * to_vector(s.posed[k].model) - to_vector(s.posed[k].scene);
    agree += gap.squaredNorm() < limit * limit ? 1U : 0U;
  }
  return matches < kFewMatches ||
         (agree >= kFewestAgree && static_cast<double>(agree) >= kAgreeShare * matches);
}

/// What a pose explains of the open points: the largest connected piece, which must stay joined to what the
/// regions so far explain.
Gain gain_of(RegistrationState& s, const InstanceBuffers& buffers, std::span<const RigidTransform> poses,
             const RigidTransform& pose, double noise) noexcept {
  measure(s, pose, noise, true);
  for (std::size_t i = 0; i < s.model.size(); ++i) s.off[i] = s.open[i] != 0 ? off_surface(s, i, noise) : -1;
  Gain gain;
  gain.piece = s.islands.pieces(
      s.model, [&](std::size_t i) { return on_surface(s.off[i]); }, gain.points);
  if (gain.points > 0 && !borne_out(s, gain.piece, pose)) gain.points = 0;
  if (s.settings.constraints && gain.points > 0 &&
      joint_gap(s, buffers.labels, poses, gain.piece, pose) > largest_joint_gap(s))
    gain.points = 0;
  return gain;
}

/// The connected pieces, in s.islands, of what a pose explains: open points, and points of other regions that
/// lie less than half as far off its surface as off their own region's. Returns the largest piece's size.
std::uint32_t explained_better(RegistrationState& s, const InstanceBuffers& buffers,
                               std::span<const RigidTransform> poses, double noise,
                               const RigidTransform& pose) noexcept {
  const std::size_t n = s.model.size();
  // s.scratch: how far each point is off its own region.
  for (std::size_t r = 0; r < poses.size(); ++r) {
    measure(s, poses[r], noise, false);
    for (std::size_t i = 0; i < n; ++i)
      if (buffers.labels[i] == static_cast<std::int8_t>(r)) s.scratch[i] = off_surface(s, i, noise);
  }
  measure(s, pose, noise, false);
  for (std::size_t i = 0; i < n; ++i) {
    s.off[i] = off_surface(s, i, noise);
    if (s.open[i] == 0 && (s.scratch[i] < kDoubtful || s.off[i] > 0.5F * s.scratch[i])) s.off[i] = -1;
  }
  std::uint32_t size = 0;
  static_cast<void>(s.islands.pieces(
      s.model, [&](std::size_t i) { return on_surface(s.off[i]); }, size));
  return size;
}

}  // namespace

bool find_region(RegistrationState& s, const InstanceBuffers& buffers, std::span<const RigidTransform> poses,
                 double noise, RigidTransform& pose) noexcept {
  const RigidTransform& base = poses[0];
  const auto least = static_cast<std::uint32_t>(std::max(40.0, 0.02 * static_cast<double>(s.model.size())));
  std::array<MatchGroup, 4> groups;
  if (s.settings.constraints) measure_reach(s, buffers.labels);
  const std::size_t matches = collect_matches(s, [&](std::size_t i, const Point3f& scene) {
    return s.open[i] != 0 &&
           (!s.settings.constraints || within_reach(s, buffers.labels, poses, i, to_vector(scene)));
  });
  GroupingSettings settings;
  settings.tolerance = match_tolerance(s);
  settings.use_frames = s.settings.frame_hypotheses;
  s.work += matches * settings.seeds * work::kVote;
  const std::size_t count = s.grouping.group(s.posed_left.first(matches), settings, s.model.radius(), groups);
  // Beside the groups: from the base's own pose, for parts that moved little; all that is open, and its
  // largest connected piece alone, which what is open elsewhere cannot pull away.
  Gain best;
  for (std::size_t k = 0; k <= count + 1; ++k) {
    RigidTransform trial = k < count ? groups[k].transform : base;
    const std::size_t part = k <= count ? open_part(s, kFinePoints) : largest_open_piece(s, kFinePoints);
    if (part < least) continue;
    const double gate = k < count ? 2 * match_tolerance(s) : (k == count ? 0.1 : 0.2) * s.model.radius();
    const AlignSettings wide = {gate, match_tolerance(s), std::max(gate, 1.5 * s.spacing), 12};
    const std::span<const std::uint16_t> some = s.part.first(std::min<std::size_t>(part, 800));
    if (align_to_base(s, some, wide, trial) == 0) continue;
    refine(s, s.part.first(part), noise, trial);
    const Gain gain = gain_of(s, buffers, poses, trial, noise);
    if (gain.points > best.points) {
      best = gain;
      pose = trial;
    }
    if (best.points > part / 2) break;  // most of what is open: nothing can beat it
  }
  if (best.points == 0) return false;
  // A part that turned by little is half explained by the region that it hangs on: what is open of it may be
  // few.
  const bool little = cos_angle(base.rotation.transpose() * pose.rotation) > kLittleTurn;
  const std::uint32_t least_open = little ? least / 2 : least;
  if (best.points < least_open) return false;
  // Once more on the piece alone.
  const Gain gain = gain_of(s, buffers, poses, pose, noise);
  if (gain.points < least_open) return false;
  std::size_t part = 0;
  for (std::size_t i = 0; i < s.model.size() && part < kFinePoints; ++i)
    if (s.islands.piece()[i] == gain.piece) s.part[part++] = static_cast<std::uint16_t>(i);
  refine(s, s.part.first(part), noise, pose);
  if (gain_of(s, buffers, poses, pose, noise).points < least_open) return false;
  const std::uint32_t size = explained_better(s, buffers, poses, noise, pose);
  if (size < least) return false;
  // Sizes of the pieces; two legs may hang together through the hip alone, which bends.
  for (std::size_t i = 0; i < s.model.size(); ++i) s.gap_nearest[i] = 0;
  for (std::size_t i = 0; i < s.model.size(); ++i)
    if (s.islands.piece()[i] != 0) ++s.gap_nearest[s.islands.piece()[i] - 1];
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    const std::uint32_t piece = s.islands.piece()[i];
    s.proposal[i] = piece != 0 && 4 * s.gap_nearest[piece - 1] >= least ? 1 : 0;
    if (s.proposal[i] == 0 || !s.settings.constraints || s.gap_nearest[piece - 1] == kJoined) continue;
    // Each piece is asked for once.
    const bool torn = joint_gap(s, buffers.labels, poses, piece, pose) > largest_joint_gap(s);
    s.gap_nearest[piece - 1] = torn ? 0 : kJoined;
    s.proposal[i] = torn ? 0 : 1;
  }
  return true;
}

void settle_borders(RegistrationState& s, InstanceBuffers& buffers, std::span<RigidTransform> poses,
                    double noise) noexcept {
  const std::size_t n = s.model.size();
  for (int pass = 0; pass < 2; ++pass) {
    // s.off: the best so far; s.proposal: whose it is.
    for (std::size_t i = 0; i < n; ++i) {
      s.off[i] = 2;
      s.proposal[i] = static_cast<std::uint32_t>(kNotObserved + 2);
    }
    for (std::size_t r = 0; r < poses.size(); ++r) {
      measure(s, poses[r], noise, false);
      const auto label = static_cast<std::int8_t>(r);
      for (std::size_t i = 0; i < n; ++i) {
        bool beside = buffers.labels[i] == label;
        for (const std::uint16_t j : s.model.neighbours(i))
          beside = beside || (j != kNoNeighbour && buffers.labels[j] == label);
        if (!beside) continue;
        const float off = off_surface(s, i, noise);
        if (!on_surface(off) || off >= s.off[i]) continue;
        s.off[i] = off;
        s.proposal[i] = static_cast<std::uint32_t>(label + 2);
      }
    }
    for (std::size_t i = 0; i < n; ++i)
      buffers.labels[i] = static_cast<std::int8_t>(static_cast<int>(s.proposal[i]) - 2);
    s.islands.filter(s.model, static_cast<std::size_t>(0.005 * static_cast<double>(n)), buffers.labels,
                     [&](std::size_t i, std::int8_t label) { return label >= 0 && buffers.labels[i] >= 0; });
    for (std::size_t i = 0; i < s.base_count; ++i)
      s.base_taken[i] = static_cast<std::uint8_t>(s.base_taken[i] & 2);
    for (std::size_t r = 0; r < poses.size(); ++r) {
      std::size_t part = 0;
      for (std::size_t i = 0; i < n && part < kFinePoints; ++i)
        if (buffers.labels[i] == static_cast<std::int8_t>(r)) s.part[part++] = static_cast<std::uint16_t>(i);
      if (part >= 40) refine(s, s.part.first(part), noise, poses[r]);
    }
    for (std::size_t r = 0; r < poses.size(); ++r)
      take_points(s, buffers, static_cast<std::int8_t>(r), poses[r], noise);
  }
}

}  // namespace pliant

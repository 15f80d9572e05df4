#include "core/registration/instance_search.hpp"

#include <algorithm>
#include <array>

#include "core/registration/chain_measures.hpp"

namespace pliant {

namespace {

constexpr double kOtherAttitude = 0.87;  // cosine of 30°
// A pose that explains less than kCertainShare of the object must explain more than its like in other
// attitudes: balls and rolls of the object's size reach 0.46 of a lumpy one, in every attitude within 0.04 of
// that; half of a dancing figure, seen in full, stays above its next best attitude by a quarter.
constexpr double kCertainShare = 0.6;
constexpr double kTwinShare = 0.85;
constexpr std::size_t kCoarsePoints = 500;
constexpr std::size_t kScorePoints = 600;
constexpr std::size_t kSingleFrames = 256;  // matches whose own poses are tried

double score_of(const RegistrationState& s, const RigidTransform& pose) noexcept {
  const std::size_t count = std::min(kScorePoints, s.model.size());
  s.work += count * work::kNearest;
  return cloud_agreement(s.model, s.prefix.first(count), working_target(s), pose, match_tolerance(s),
                         working_reach(s)) /
         static_cast<double>(count);
}

/// A pose on trial.
struct Trial {
  RigidTransform pose;
  double score = -1;
};

void try_pose(const RegistrationState& s, RigidTransform pose, double gate, Trial& best) noexcept {
  if (s.settings.refinement) {
    const double tolerance = match_tolerance(s);
    const AlignSettings coarse = {gate, tolerance, working_reach(s), 8};
    const std::size_t count = std::min(kCoarsePoints, s.model.size());
    s.work += count * static_cast<std::size_t>(coarse.iterations) * work::kNearest;
    static_cast<void>(align_to_cloud(s.model, s.prefix.first(count), working_target(s), coarse, pose));
  }
  const double score = score_of(s, pose);
  if (score > best.score) best = {pose, score};
}

/// Poses that single matches propose by their local frames, the best matches first.
void try_single_frames(RegistrationState& s, std::span<const PosedMatch> matches, Trial& best) noexcept {
  std::array<Trial, 8> top;
  const double coarse = 0.08 * s.model.radius();
  const std::size_t step = std::max<std::size_t>(1, matches.size() / kSingleFrames);
  const std::size_t count = std::min<std::size_t>(100, s.model.size());
  for (std::size_t k = 0; k < matches.size(); k += step) {
    Trial trial;
    trial.pose = pose_from_frames(matches[k]);
    s.work += count * work::kNearest;
    trial.score = cloud_agreement(s.model, s.prefix.first(count), working_target(s), trial.pose, coarse,
                                  std::max(coarse, working_reach(s)));
    for (Trial& held : top)
      if (trial.score > held.score) std::swap(trial, held);
  }
  for (const Trial& trial : top)
    if (trial.score >= 0) try_pose(s, trial.pose, coarse, best);
}

/// The model fits about as well at the same place in another attitude, after quarter and half turns about its
/// axes. What fits as well turned away, such as a ball, does not tell that it is the object.
bool has_twin(const RegistrationState& s, const Trial& best) noexcept {
  for (int axis = 0; axis < 3; ++axis)
    for (int quarters = 1; quarters < 4; ++quarters) {
      Matrix3 turn = Matrix3::Identity();
      const double cosine = quarters == 2 ? -1 : 0, sine = quarters == 1 ? 1 : quarters == 2 ? 0 : -1;
      const int i = (axis + 1) % 3, j = (axis + 2) % 3;
      turn(i, i) = turn(j, j) = cosine;
      turn(i, j) = -sine;
      turn(j, i) = sine;
      RigidTransform pose;
      pose.rotation = best.pose.rotation * turn;
      pose.translation = best.pose * s.model.centre() - pose.rotation * s.model.centre();
      Trial trial;
      try_pose(s, pose, 2 * match_tolerance(s), trial);
      const bool back = cos_angle(trial.pose.rotation.transpose() * best.pose.rotation) > kOtherAttitude;
      if (!back && trial.score > kTwinShare * best.score) return true;
    }
  return false;
}

}  // namespace

double find_instance(RegistrationState& s, RigidTransform& pose) noexcept {
  const std::size_t matches = collect_matches(s, [](std::size_t, const Point3f&) { return true; });
  const std::span<const PosedMatch> left = s.posed_left.first(matches);
  Trial best;
  if (s.settings.grouping) {
    std::array<MatchGroup, Grouping::kMostGroups> groups;
    GroupingSettings settings;
    settings.tolerance = match_tolerance(s);
    settings.use_frames = s.settings.frame_hypotheses;
    s.work += left.size() * settings.seeds * work::kVote;
    const std::size_t count = s.grouping.group(left, settings, s.model.radius(), groups);
    for (std::size_t k = 0; k < count; ++k) {
      // A group with a fraction of the best one's members and a clear winner before it need not be tried.
      if (best.score > 0.5 && 2 * groups[k].members < groups[0].members) break;
      if (best.score > 0.8) break;
      try_pose(s, groups[k].transform, 2 * match_tolerance(s), best);
    }
  }
  if (s.settings.frame_hypotheses && best.score < 0.3) try_single_frames(s, left, best);
  if (best.score < 0) return best.score;
  if (best.score >= kDoubtfulShare && best.score < kCertainShare && has_twin(s, best)) return -1;
  pose = best.pose;
  refine(s, s.prefix.first(std::min(kFinePoints, s.model.size())), 0, pose);
  return best.score;
}

}  // namespace pliant

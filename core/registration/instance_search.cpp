#include "core/registration/instance_search.hpp"

#include <algorithm>
#include <array>

#include "core/registration/chain_measures.hpp"

namespace pliant {

namespace {

constexpr std::size_t kCoarsePoints = 500;
constexpr std::size_t kScorePoints = 600;
constexpr std::size_t kSingleFrames = 256;  // matches whose own poses are tried

double score_of(const RegistrationState& s, const RigidTransform& pose) noexcept {
  const std::size_t count = std::min(kScorePoints, s.model.size());
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
    trial.score = cloud_agreement(s.model, s.prefix.first(count), working_target(s), trial.pose, coarse,
                                  std::max(coarse, working_reach(s)));
    for (Trial& held : top)
      if (trial.score > held.score) std::swap(trial, held);
  }
  for (const Trial& trial : top)
    if (trial.score >= 0) try_pose(s, trial.pose, coarse, best);
}

}  // namespace

double find_instance(RegistrationState& s, RigidTransform& pose) noexcept {
  const std::size_t matches = collect_matches(s, [](std::size_t) { return true; });
  const std::span<const PosedMatch> left = s.posed_left.first(matches);
  Trial best;
  if (s.settings.grouping) {
    std::array<MatchGroup, Grouping::kMostGroups> groups;
    GroupingSettings settings;
    settings.tolerance = match_tolerance(s);
    settings.use_frames = s.settings.frame_hypotheses;
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
  refine(s, s.prefix.first(std::min(kFinePoints, s.model.size())), 0, best.pose);
  pose = best.pose;
  return best.score;
}

}  // namespace pliant

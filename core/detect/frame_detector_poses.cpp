// The middle stages of the search in a picture: poses proposed by single matches and by votes, and which of
// them are worth a close look.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/detect/frame_detector.hpp"
#include "core/detect/work.hpp"

namespace pliant {

namespace {

constexpr std::size_t kQuickPoints = 64;  // first look at a proposal
constexpr std::size_t kLookPoints = 128;  // look at what has votes; of thin limbs, few of these are in sight
// Of the proposals brought nearer by two steps, one in four is brought nearer still. Of 123 rounds that had a
// right proposal, of figures with thin limbs, two had none among those that held most firmly before the
// second step, nine none among the quarter that look best where their local frames put them.
constexpr int kFirstSteps = 2, kAllSteps = 3;
constexpr std::size_t kPromisingShare = 4;
constexpr double kPlainWeight =
    0.3;  // of agreeing with a wall, at the first look: any pose can sink into one

/// The `count` best of some proposals to their front, best first.
template <typename Proposals>
void put_best_first(Proposals all, std::size_t count) noexcept {
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(),
                    [](const auto& a, const auto& b) {
                      if (a.score != b.score) return a.score > b.score;
                      return a.scene != b.scene ? a.scene < b.scene : a.model < b.model;
                    });
}

}  // namespace

RigidTransform FrameDetector::pose_of(const Proposal& proposal) const noexcept {
  const Matrix3 rotation =
      axes_of(frames_[proposal.scene]).transpose() * axes_of(model_.frames()[proposal.model]);
  return {rotation,
          to_vector(key_points_[proposal.scene]) - rotation * to_vector(model_.positions()[proposal.model])};
}

void FrameDetector::align(std::size_t count, const AlignSchedule& schedule, RigidTransform& pose) noexcept {
  const int steps = align_pose(probe_, snapshot_, count, schedule, pose);
  work_ += static_cast<std::uint64_t>(steps) * (count * work::kProbeStep + work::kSolve);
}

PoseEvidence FrameDetector::look_at(const RigidTransform& pose, std::size_t count, double tolerance,
                                    double plain_weight) noexcept {
  work_ += count * work::kProbeLook;
  return pose_evidence(probe_, snapshot_, pose, count, tolerance, widest_, plain_weight);
}

std::int64_t FrameDetector::slice_propose() noexcept {
  constexpr std::size_t kBatch = 128;
  const std::size_t last = std::min(cursor_ + kBatch, proposal_count_);
  const AlignSchedule nearer = {coarse_, fine_, kAllSteps};
  for (; cursor_ < last; ++cursor_) {
    Proposal& p = proposals_[cursor_];
    RigidTransform pose = pose_of(p);
    votes_.add(pose, round_ * settings_.keypoints + p.scene);
    if (settings_.thorough) {
      // A thin limb meets nothing from where a local frame puts it: what is seen there says little of a pose.
      // How firmly it holds once it was brought nearer tells right ones from wrong ones.
      p.draft = static_cast<std::uint16_t>(cursor_);
      double support = -1;
      for (int step = 0; step < kFirstSteps; ++step) {
        work_ += kLookPoints * work::kProbeStep + work::kSolve;
        support = align_step(probe_, snapshot_, kLookPoints, nearer.reach(step), pose);
        if (support < 0) break;
      }
      drafts_[cursor_] = FastTransform(pose);
      p.score = static_cast<float>(support);
    } else {
      p.score = static_cast<float>(look_at(pose, kQuickPoints, coarse_, kPlainWeight).score());
    }
  }
  if (cursor_ >= proposal_count_) {
    votes_.index();
    phase_ = settings_.thorough ? Phase::narrow : Phase::vote;
    cursor_ = 0;
    judged_count_ = settings_.thorough ? proposal_count_ / kPromisingShare : proposal_count_;
    if (settings_.thorough) put_best_first(proposals_.first(proposal_count_), judged_count_);
  }
  return static_cast<std::int64_t>(kBatch) * (settings_.thorough ? 16 : 8);
}

std::int64_t FrameDetector::slice_narrow() noexcept {
  // The promising ones are brought nearer still, and judged.
  constexpr std::size_t kBatch = 128;
  const std::size_t last = std::min(cursor_ + kBatch, judged_count_);
  const AlignSchedule nearer = {coarse_, fine_, kAllSteps};
  for (; cursor_ < last; ++cursor_) {
    Proposal& p = proposals_[cursor_];
    RigidTransform pose = drafts_[p.draft].rigid();
    for (int step = kFirstSteps; step < nearer.steps && p.score >= 0; ++step) {
      work_ += kLookPoints * work::kProbeStep + work::kSolve;
      p.score = static_cast<float>(align_step(probe_, snapshot_, kLookPoints, nearer.reach(step), pose));
    }
    p.score = static_cast<float>(look_at(pose, kLookPoints, fine_, kPlainWeight).score());
  }
  if (cursor_ >= judged_count_) {
    phase_ = Phase::vote;
    cursor_ = 0;
  }
  return static_cast<std::int64_t>(kBatch) * 16;
}

std::int64_t FrameDetector::slice_vote() noexcept {
  constexpr std::size_t kBatch = 128;
  const std::size_t first = votes_.size() - proposal_count_ + cursor_;
  work_ += kBatch * work::kPoseVote;
  votes_.count_votes(first, std::min(first + kBatch, votes_.size()));
  cursor_ += kBatch;
  if (cursor_ >= proposal_count_) {
    voted_count_ = votes_.best(voted_);
    phase_ = Phase::look;
    cursor_ = 0;
    return static_cast<std::int64_t>(kBatch * 11 + 2 * votes_.size());
  }
  return kBatch * 11;
}

std::int64_t FrameDetector::slice_look() noexcept {
  // Poses by local frames are too far off to judge: they are brought a little nearer first.
  constexpr std::size_t kBatch = 16;
  const std::size_t last = std::min(cursor_ + kBatch, voted_count_);
  for (; cursor_ < last; ++cursor_) {
    RigidTransform pose = votes_.mean_pose(voted_[cursor_]);
    align(kLookPoints, {2 * coarse_, fine_, 4}, pose);
    looks_[cursor_].scene = static_cast<std::uint16_t>(cursor_);
    looks_[cursor_].model = 0;
    looks_[cursor_].score = static_cast<float>(look_at(pose, kLookPoints, coarse_, kPlainWeight).score());
  }
  if (cursor_ >= voted_count_) {
    fill_shortlist();
    phase_ = Phase::shortlist;
    cursor_ = 0;
    if (hinted_ && round_ == 0) try_pose(hint_);
  }
  return kBatch * 100;
}

void FrameDetector::fill_shortlist() noexcept {
  shortlist_count_ = std::min(kByVotes, voted_count_);
  put_best_first(std::span(looks_).first(voted_count_), shortlist_count_);
  for (std::size_t k = 0; k < shortlist_count_; ++k) {
    shortlist_[k] = votes_.mean_pose(voted_[looks_[k].scene]);
    votes_.spend(voted_[looks_[k].scene]);
  }
  const std::size_t others = std::min(kShortlist - shortlist_count_, judged_count_);
  put_best_first(proposals_.first(judged_count_), others);
  for (std::size_t k = 0; k < others; ++k) shortlist_[shortlist_count_++] = pose_of(proposals_[k]);
}

}  // namespace pliant

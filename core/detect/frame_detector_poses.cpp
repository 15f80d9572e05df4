// The later stages of the search in a picture: poses proposed by single matches, judged, refined, decided on.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/detect/frame_detector.hpp"
#include "core/detect/seam.hpp"

namespace pliant {

namespace {

constexpr std::size_t kQuickPoints = 64;  // first look at a proposal
constexpr std::size_t kLookPoints = 128;  // look at what has votes; of thin limbs, few of these are in sight
constexpr std::size_t kCloseLookPoints = 200;  // second look
constexpr std::size_t kAlignPoints = 400;      // full refinement
constexpr double kPlainWeight =
    0.3;  // of agreeing with a wall, at the first look: any pose can sink into one

// What scores so low that clutter reaches it must have the descriptors on its side: of the keypoints that lie
// on the object, so many have their best match near the right place. By chance about one in a hundred has, on
// a deformed real object one in twenty.
constexpr double kLeastSupport = 0.04;
constexpr std::size_t kFewestSupporters = 4;

Vector3 to_vector(const Point3f& p) noexcept {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

/// Rows of the frame as a rotation: local <- cloud.
Matrix3 axes_of(const LocalFrame& frame) noexcept {
  Matrix3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = frame.axes[static_cast<std::size_t>(i)] / 16384.0;
  return m;
}

constexpr std::size_t kCubeAttitudes = 24;

/// One of the turns that take a cube to itself, the first one none.
Matrix3 cube_attitude(std::size_t k) noexcept {
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  const auto& order = kOrders[k / 4];
  const double first = (k & 1) != 0 ? -1 : 1, second = (k & 2) != 0 ? -1 : 1;
  const double third = (k / 4 < 3 ? 1 : -1) * first * second;  // no mirror
  Matrix3 turn = Matrix3::Zero();
  turn(order[0], 0) = first;
  turn(order[1], 1) = second;
  turn(order[2], 2) = third;
  return turn;
}

}  // namespace

RigidTransform FrameDetector::pose_of(const Proposal& proposal) const noexcept {
  const Matrix3 rotation =
      axes_of(frames_[proposal.scene]).transpose() * axes_of(model_.frames()[proposal.model]);
  return {rotation,
          to_vector(key_points_[proposal.scene]) - rotation * to_vector(model_.positions()[proposal.model])};
}

std::int64_t FrameDetector::slice_propose() noexcept {
  constexpr std::size_t kBatch = 128;
  const std::size_t last = std::min(cursor_ + kBatch, proposal_count_);
  // A thin limb meets nothing from where a local frame puts it: it looks as bad as any wrong pose at first.
  const bool nearer = settings_.thorough && round_ > 0;
  for (; cursor_ < last; ++cursor_) {
    Proposal& p = proposals_[cursor_];
    RigidTransform pose = pose_of(p);
    votes_.add(pose, round_ * settings_.keypoints + p.scene);
    if (nearer) refine_pose(model_, snapshot_, kLookPoints, coarse_, fine_, 3, pose);
    p.score = static_cast<float>(pose_evidence(model_, snapshot_, pose, nearer ? kLookPoints : kQuickPoints,
                                               nearer ? fine_ : coarse_, widest_, kPlainWeight)
                                     .score());
  }
  if (cursor_ >= proposal_count_) {
    votes_.index();
    phase_ = Phase::vote;
    cursor_ = 0;
  }
  return static_cast<std::int64_t>(kBatch) * (nearer ? 60 : 8);
}

std::int64_t FrameDetector::slice_vote() noexcept {
  constexpr std::size_t kBatch = 128;
  const std::size_t first = votes_.size() - proposal_count_ + cursor_;
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
    refine_pose(model_, snapshot_, kLookPoints, 2 * coarse_, fine_, 4, pose);
    looks_[cursor_].scene = static_cast<std::uint16_t>(cursor_);
    looks_[cursor_].model = 0;
    looks_[cursor_].score = static_cast<float>(
        pose_evidence(model_, snapshot_, pose, kLookPoints, coarse_, widest_, kPlainWeight).score());
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
  const auto put_best_first = [](std::span<Proposal> all, std::size_t count) {
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(),
                      [](const Proposal& a, const Proposal& b) {
                        if (a.score != b.score) return a.score > b.score;
                        return a.scene != b.scene ? a.scene < b.scene : a.model < b.model;
                      });
  };
  shortlist_count_ = std::min(kByVotes, voted_count_);
  put_best_first(std::span(looks_).first(voted_count_), shortlist_count_);
  for (std::size_t k = 0; k < shortlist_count_; ++k) {
    shortlist_[k] = votes_.mean_pose(voted_[looks_[k].scene]);
    votes_.spend(voted_[looks_[k].scene]);
  }
  const std::size_t others = std::min(kShortlist - shortlist_count_, proposal_count_);
  put_best_first(proposals_.first(proposal_count_), others);
  for (std::size_t k = 0; k < others; ++k) shortlist_[shortlist_count_++] = pose_of(proposals_[k]);
}

void FrameDetector::judge(PoseCandidate& candidate, std::size_t count, double floor) const noexcept {
  candidate.evidence = pose_evidence(model_, snapshot_, candidate.pose, count, fine_, widest_);
  candidate.score = candidate.evidence.score();
  candidate.seamless = 0;
  if (candidate.score <= 0 || candidate.score <= floor) return;  // the seam could only lower it
  candidate.seamless = seam_evidence(model_, snapshot_, candidate.pose, kEvidencePoints, 0.5 * fine_).share();
  candidate.score -= candidate.seamless;
}

void FrameDetector::try_pose(const RigidTransform& pose) noexcept {
  PoseCandidate candidate;
  candidate.pose = pose;
  refine_pose(model_, snapshot_, kCloseLookPoints, coarse_, fine_, 4, candidate.pose);
  // What scores below every finalist is dropped anyway.
  judge(candidate, kCloseLookPoints, finalists_.floor());
  finalists_.keep(candidate);
}

std::int64_t FrameDetector::slice_shortlist() noexcept {
  if (cursor_ < shortlist_count_) {
    try_pose(shortlist_[cursor_++]);
  }
  if (cursor_ >= shortlist_count_) {
    phase_ = Phase::settle;
    cursor_ = 0;
  }
  return 600;
}

std::int64_t FrameDetector::slice_settle() noexcept {
  if (cursor_ < finalists_.all().size()) {
    PoseCandidate& candidate = finalists_.all()[cursor_++];
    // The object may have deformed: a pose that fits all of it fairly says that it is there, one that fits
    // its largest rigid part closely says where.
    refine_pose(model_, snapshot_, kAlignPoints, 2 * fine_, 0.5 * fine_, 6, candidate.pose);
    judge(candidate, kEvidencePoints, -10);
    PoseCandidate close = candidate;
    refine_pose(model_, snapshot_, kAlignPoints, fine_, 0.1 * fine_, 8, close.pose);
    judge(close, kEvidencePoints, -10);
    const double score = std::max(candidate.score, close.score);
    if (close.score > 0.5 * candidate.score) candidate = close;
    candidate.score = score;
  }
  if (cursor_ >= finalists_.all().size()) {
    const Detection best = finalists_.best();
    if (best.score > 0 && !verdict_on(best).certain) {
      challenged_ = best.pose;
      phase_ = Phase::challenge;
      cursor_ = 0;
    } else {
      decide();
    }
  }
  return 2300;
}

std::int64_t FrameDetector::slice_challenge() noexcept {
  // Proposals need not have come near the attitudes in which a thing of a like shape would fit as well.
  const Matrix3 turn = cube_attitude(++cursor_);
  const Vector3& centre = model_.centre();
  try_pose(challenged_ * RigidTransform{turn, centre - turn * centre});
  if (cursor_ + 1 >= kCubeAttitudes) decide();
  return 600;
}

bool FrameDetector::supported(const RigidTransform& pose) const noexcept {
  const RigidTransform back = pose.inverse();
  const std::size_t looked = std::min(kEvidencePoints, model_.size());
  std::size_t on = 0, supporters = 0;
  for (std::size_t k = 0; k < key_count_; ++k) {
    const Vector3 key = back * to_vector(key_points_[k]);
    const Vector3 out = key - model_.centre();
    if (out.dot(out) > 1.21 * model_.radius() * model_.radius()) continue;
    bool near = false;
    for (std::size_t i = 0; i < looked && !near; ++i) {
      const Vector3 gap = to_vector(model_.positions()[i]) - key;
      near = gap.dot(gap) < coarse_ * coarse_;
    }
    if (!near) continue;
    ++on;
    const Vector3 gap = to_vector(model_.positions()[matches_[k * settings_.matches].model]) - key;
    supporters += gap.dot(gap) < 4 * coarse_ * coarse_ ? 1U : 0U;
  }
  return supporters >= kFewestSupporters &&
         static_cast<double>(supporters) >= kLeastSupport * static_cast<double>(on);
}

void FrameDetector::decide() noexcept {
  best_ = finalists_.best();
  const Verdict verdict = verdict_on(best_);
  const bool all_described = order_next_ >= order_count_;
  const bool last = round_ + 1 >= settings_.rounds || all_described;
  // The last resort is for who has looked at everything, or nearly.
  const bool believed = verdict.convincing || ((all_described || round_ >= 2) && verdict.last_resort &&
                                               (verdict.clear || supported(best_.pose)));
  if (believed) {
    state_ = DetectState::found;
  } else if (last) {
    state_ = DetectState::nothing;
  } else {
    ++round_;
    begin_round();
  }
}

}  // namespace pliant

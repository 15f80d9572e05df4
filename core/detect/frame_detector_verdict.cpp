// The last stages of the search in a picture: poses looked at closely, refined in full, and decided on.
#include <algorithm>
#include <array>

#include "core/detect/frame_detector.hpp"
#include "core/detect/seam.hpp"
#include "core/detect/self_likeness.hpp"
#include "core/detect/work.hpp"

namespace pliant {

namespace {

constexpr std::size_t kCloseLookPoints = 192;
constexpr std::size_t kAlignPoints = 416;  // full refinement
constexpr std::size_t kLikenessPoints = 64;
constexpr std::size_t kMostChallenges = 3;  // in a round: one after another of what turns out to be plain
constexpr double kLooksAlike = 0.9;         // of the model, on itself: but for a cup's handle

// What scores so low that clutter reaches it must have the descriptors on its side: of the keypoints that lie
// on the object, so many have their best match near the right place. By chance about one in a hundred has, on
// a deformed real object one in twenty.
constexpr double kLeastSupport = 0.04;
constexpr std::size_t kFewestSupporters = 4;

constexpr std::size_t kCubeAttitudes = 24;
constexpr std::size_t kNearAttitudes = 6;
constexpr double kNearTurn = 0.2;  // radians: what a local frame is off

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

/// A turn by a little about one of the axes, one way or the other.
Matrix3 near_attitude(std::size_t k) noexcept {
  Vector3 turn = Vector3::Zero();
  turn(static_cast<int>(k / 2)) = k % 2 != 0 ? -kNearTurn : kNearTurn;
  return rotation_from_small_vector(turn);
}

}  // namespace

void FrameDetector::judge(PoseCandidate& candidate, std::size_t count, double floor) noexcept {
  candidate.evidence = look_at(candidate.pose, count, fine_);
  candidate.score = candidate.evidence.score();
  candidate.seamless = 0;
  if (candidate.score <= 0 || candidate.score <= floor) return;  // the seam could only lower it
  work_ += work::kSeam;
  candidate.seamless = seam_evidence(model_, snapshot_, candidate.pose, kEvidencePoints, 0.5 * fine_).share();
  candidate.score -= candidate.seamless;
}

void FrameDetector::try_pose(const RigidTransform& pose) noexcept {
  PoseCandidate candidate;
  candidate.pose = pose;
  align(kCloseLookPoints, {coarse_, fine_, 4}, candidate.pose);
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
  std::int64_t took = 1;
  if (cursor_ < finalists_.all().size()) {
    PoseCandidate& candidate = finalists_.all()[cursor_++];
    if (!candidate.settled) {
      // The object may have deformed: a pose that fits all of it fairly says that it is there, one that fits
      // its largest rigid part closely says where.
      align(kAlignPoints, {2 * fine_, 0.5 * fine_, 6}, candidate.pose);
      judge(candidate, kEvidencePoints, -10);
      PoseCandidate close = candidate;
      align(kAlignPoints, {fine_, 0.1 * fine_, 8}, close.pose);
      judge(close, kEvidencePoints, -10);
      const double score = std::max(candidate.score, close.score);
      if (close.score > 0.5 * candidate.score) candidate = close;
      candidate.score = score;
      candidate.settled = true;
      return 2300;
    }
  }
  if (cursor_ >= finalists_.all().size()) {
    const std::uint64_t before = work_;
    const Detection best = best_so_far();
    took += static_cast<std::int64_t>((work_ - before) / 1000);
    if (best.score > 0 && is_plain(best)) {
      // The object may stand beside it.
      finalists_.dismiss(best);
      challenged_ = challenges_ >= kMostChallenges;
      cursor_ = 0;
    } else if (!challenged_ && best.score > 0 && needs_other_attitudes(best)) {
      challenge_ = best.pose;
      ++challenges_;
      phase_ = Phase::challenge;
      cursor_ = 0;
    } else {
      decide(best);
    }
  }
  return took;
}

std::int64_t FrameDetector::slice_challenge() noexcept {
  // Proposals need not have come near the attitudes in which a thing of a like shape would fit as well, and
  // the best one may have come to rest beside the right one.
  ++cursor_;
  const Matrix3 turn =
      cursor_ < kCubeAttitudes ? cube_attitude(cursor_) : near_attitude(cursor_ - kCubeAttitudes);
  const Vector3& centre = model_.centre();
  try_pose(challenge_ * RigidTransform{turn, centre - turn * centre});
  if (cursor_ + 1 >= kCubeAttitudes + kNearAttitudes) {
    challenged_ = true;
    phase_ = Phase::settle;
    cursor_ = 0;
  }
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

Detection FrameDetector::best_so_far() noexcept {
  Detection best = finalists_.best();
  if (best.score <= 0) return best;
  work_ += work::kPlainBody;
  best.plain = plain_body_fit(probe_, snapshot_, best.pose, kEvidencePoints, fine_, widest_);
  if (!best.plain.quadric_is_nearer()) return best;  // otherwise it is not asked for
  const RigidTransform back = best.pose.inverse();
  best.other = finalists_.best_twin(best, [&](const RigidTransform& pose) {
    work_ += work::kSelfLikeness;
    return self_likeness(model_, back * pose, kLikenessPoints, fine_) < kLooksAlike;
  });
  return best;
}

void FrameDetector::decide(const Detection& best) noexcept {
  best_ = best;
  const Verdict verdict = verdict_on(best_);
  const bool all_described = order_next_ >= order_count_;
  const bool last = round_ + 1 >= settings_.rounds || all_described;
  // The last resort is for who has looked at everything, or nearly.
  const bool thorough = all_described || round_ >= 2;
  const bool believed = verdict.convincing || (settings_.confirmed && verdict.again) ||
                        (thorough && verdict.clear) ||
                        ((verdict.likely || (thorough && verdict.last_resort)) && supported(best_.pose));
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

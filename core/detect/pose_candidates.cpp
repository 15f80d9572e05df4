#include "core/detect/pose_candidates.hpp"

#include <algorithm>

namespace pliant {

namespace {

// What a pose must score, and how far below the best pose elsewhere must stay: half. In 250 pictures of five
// meshes the best place elsewhere reached 0.47 of the right one's score where that was below kCertain.
// Clutter reaches 0.4, but fits in several attitudes then: of 250 pictures without the object in none by less
// than kMostDoubt when it was more than 0.33. Once every keypoint has been tried, a lone pose is believed
// earlier.
constexpr double kCertain = 0.45;
constexpr double kConvincing = 0.35;
constexpr double kLikely = 0.28;
constexpr double kLastResort = 0.22;
constexpr double kRivalShare = 0.5;
// Something round lies within the tolerance of much of another round thing, less closely than the object
// itself would (PoseEvidence::unexplained), and in several attitudes. In pictures of clutter the sum of both
// shares is 0.35 to 1; in those of objects, also deformed and real ones, up to 0.28.
constexpr double kMostDoubt = 0.3;
constexpr double kBeyondDoubt = 0.5;
// Scores that clutter reaches too are believed of a fit that is close, and clearly better than in any other
// attitude: deformed real objects leave 0.2 unexplained and reach a third elsewhere, clutter more of the one
// or the other.
constexpr double kLittleUnexplained = 0.22;
constexpr double kLittleTwin = 0.35;
// The object itself, half hidden, scores as low; noise explains its fit then, and no other attitude and no
// other place fits at all. Clutter that scores as much leaves a tenth unexplained, or fits in several ways.
constexpr double kClearDoubt = 0.06;
constexpr double kClear = 0.2;
// Noisier sensors than descriptors bear leave such a fit, seen again and again: a printed dragon before a
// stereo camera 0.05 to 0.13. Half of what clutter leaves at the least.
constexpr double kDoubtOfOne = 0.5 * kMostDoubt;
constexpr double kMostOutside =
    0.4;  // of the facing points; with more out of the picture, only certainty counts

// What noise may leave unexplained of any fit.
constexpr double kSurelyUnexplained = 0.02;

}  // namespace

void PoseCandidates::start(const Vector3& centre, double radius) noexcept {
  centre_ = centre;
  radius_ = radius;
  count_ = 0;
}

bool PoseCandidates::same_place(const RigidTransform& a, const RigidTransform& b) const noexcept {
  const Vector3 apart = a * centre_ - b * centre_;
  return apart.dot(apart) < 0.09 * radius_ * radius_ && cos_angle(a.rotation.transpose() * b.rotation) > 0.9;
}

void PoseCandidates::keep(const PoseCandidate& candidate) noexcept {
  for (const PoseCandidate& held : all()) {
    const Vector3 apart = candidate.pose * centre_ - held.pose * centre_;
    if (held.dismissed && candidate.score <= held.score && apart.dot(apart) < radius_ * radius_) return;
  }
  for (PoseCandidate& held : all())
    if (same_place(held.pose, candidate.pose)) {
      if (candidate.score > held.score) held = candidate;
      return;
    }
  if (count_ < kMost) {
    held_[count_++] = candidate;
    return;
  }
  std::size_t worst = 0;
  for (std::size_t k = 1; k < count_; ++k)
    if (held_[k].score < held_[worst].score) worst = k;
  if (candidate.score > held_[worst].score) held_[worst] = candidate;
}

double PoseCandidates::floor() const noexcept {
  if (count_ < kMost) return -10;
  double least = 10;
  for (const PoseCandidate& held : all()) least = std::min(least, held.score);
  return least;
}

Detection PoseCandidates::best() const noexcept {
  Detection best;
  const PoseCandidate* first = nullptr;
  for (const PoseCandidate& held : all())
    if (!held.dismissed && (first == nullptr || held.score > first->score)) first = &held;
  if (first == nullptr) return best;
  best.pose = first->pose;
  best.score = first->score;
  best.evidence = first->evidence;
  best.seamless = first->seamless;
  for (const PoseCandidate& other : all()) {
    if (same_place(other.pose, best.pose)) continue;
    const bool here = stands_at(other, best);
    if (other.dismissed && !here) continue;  // what stands elsewhere is something else
    double& against = here ? best.twin : best.rival;
    against = std::max(against, weight_against(other, best));
  }
  return best;
}

void PoseCandidates::dismiss(const Detection& best) noexcept {
  std::size_t kept = 0;
  for (PoseCandidate& held : all()) {
    if (!held.dismissed && stands_at(held, best)) continue;
    held.dismissed = held.dismissed || same_place(held.pose, best.pose);
    held_[kept++] = held;
  }
  count_ = kept;
}

bool PoseCandidates::stands_at(const PoseCandidate& other, const Detection& best) const noexcept {
  const Vector3 apart = other.pose * centre_ - best.pose * centre_;
  return apart.dot(apart) < radius_ * radius_ && !same_place(other.pose, best.pose);
}

double PoseCandidates::weight_against(const PoseCandidate& other, const Detection& best) noexcept {
  const double left = best.evidence.unexplained() + kSurelyUnexplained;
  const double weight = std::min(1.0, left / (other.evidence.unexplained() + kSurelyUnexplained));
  return other.score > 0 ? other.score * weight : other.score;
}

namespace {

/// Fits nearly as well in an attitude in which it looks different.
bool fits_otherwise(const Detection& detection) noexcept {
  return detection.other > kRivalShare * detection.score;
}

}  // namespace

bool is_plain(const Detection& detection) noexcept {
  const PlainBodyFit& fit = detection.plain;
  // What is flat is bent by a sensor's fixed errors, within its noise: that is no ball. And several pieces
  // fit a lot, if not closely, of what is dented or noisy; but a box fits in several attitudes.
  return (fit.quadric_is_nearer() && (fit.model > fit.noise || fits_otherwise(detection))) ||
         fit.pieces_explain() || (fit.faces_are_nearer() && detection.twin > kRivalShare * detection.score);
}

bool needs_other_attitudes(const Detection& detection) noexcept {
  return detection.score < kCertain || detection.plain.quadric_is_nearer() ||
         detection.plain.faces_are_nearer();
}

Verdict verdict_on(const Detection& detection) noexcept {
  const bool lone = detection.rival <= kRivalShare * detection.score;
  const bool in_sight = detection.evidence.outside <= kMostOutside * detection.evidence.facing;
  // How much speaks for another thing of a like shape: what noise does not explain, and how well the model
  // fits in another attitude.
  const double doubt = detection.evidence.unexplained() +
                       (detection.score > 0 ? std::max(detection.twin, 0.0) / detection.score : 0);
  const bool plain = is_plain(detection);
  const bool itself = !plain && (doubt <= kMostDoubt || detection.score >= kBeyondDoubt);
  Verdict verdict;
  verdict.certain = detection.score >= kCertain;
  verdict.likely = itself && detection.score >= kLikely && lone && in_sight;
  verdict.convincing =
      itself &&
      (verdict.certain || (verdict.likely && (detection.score >= kConvincing || doubt <= kClearDoubt)));
  verdict.again = !plain && doubt <= kDoubtOfOne && lone && in_sight && detection.score >= kLastResort;
  verdict.clear = !plain && doubt <= kClearDoubt && lone && in_sight && detection.score >= kClear;
  verdict.last_resort = verdict.clear || (!plain && detection.evidence.unexplained() <= kLittleUnexplained &&
                                          detection.twin <= kLittleTwin * detection.score && lone &&
                                          in_sight && detection.score >= kLastResort);
  return verdict;
}

}  // namespace pliant

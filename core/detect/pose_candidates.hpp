// The poses that a search in a picture looked at closely, and what to make of them.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/detect/plain_body.hpp"
#include "core/detect/pose_evidence.hpp"

namespace pliant {

struct Detection {
  RigidTransform pose;    ///< camera <- model, in the frame given to begin()
  double score = -10;     ///< PoseEvidence::score() of the refined pose less its seamless share, at most 1
  double rival = -10;     ///< of the best pose at another place: more than the model's radius away
  double twin = -10;      ///< of the best pose at the same place in another attitude: near `score` for a
                          ///< symmetric object, whose attitude is then one of several
  double other = -10;     ///< the same, of attitudes in which the model looks different; where `plain` asks
  PoseEvidence evidence;  ///< over kEvidencePoints model points
  double seamless = 0;    ///< SeamEvidence::share()
  PlainBodyFit plain;     ///< of the readings on it
};

/// A pose that was looked at closely.
struct PoseCandidate {
  RigidTransform pose;
  double score = -10;
  PoseEvidence evidence;
  double seamless = 0;
  bool settled = false;    ///< refined in full
  bool dismissed = false;  ///< something plain stands there
};

/// A few distinct poses, the better one of each place.
class PoseCandidates {
 public:
  static constexpr std::size_t kMost = 12;

  /// `centre` and `radius`: of the model, metres.
  void start(const Vector3& centre, double radius) noexcept;
  void clear() noexcept { count_ = 0; }
  void keep(const PoseCandidate& candidate) noexcept;
  /// What a further one must score to be kept at a place of its own; -10 while there is room.
  [[nodiscard]] double floor() const noexcept;
  [[nodiscard]] std::span<PoseCandidate> all() noexcept { return {held_.data(), count_}; }
  [[nodiscard]] std::span<const PoseCandidate> all() const noexcept { return {held_.data(), count_}; }
  /// The best one, with what speaks against it: poses that came to it while being refined are no rivals of
  /// its.
  [[nodiscard]] Detection best() const noexcept;
  /// Drops the poses at the place of `best` and sets it aside: best() is of the others, and what scores less
  /// at its place is no longer kept.
  void dismiss(const Detection& best) noexcept;
  /// Of the poses that Detection::twin is of, the best one of which `differs(pose)` says that it counts; -10
  /// without one.
  template <typename Differs>
  [[nodiscard]] double best_twin(const Detection& best, Differs&& differs) const noexcept {
    double strongest = -10;
    for (const PoseCandidate& other : all())
      if (stands_at(other, best) && weight_against(other, best) > strongest && differs(other.pose))
        strongest = weight_against(other, best);
    return strongest;
  }

 private:
  /// At the place of `best`, but in another attitude.
  [[nodiscard]] bool stands_at(const PoseCandidate& other, const Detection& best) const noexcept;
  /// What the other one's score says against `best`: what fits less closely speaks less against it.
  [[nodiscard]] static double weight_against(const PoseCandidate& other, const Detection& best) noexcept;
  [[nodiscard]] bool same_place(const RigidTransform& a, const RigidTransform& b) const noexcept;

  Vector3 centre_ = Vector3::Zero();
  double radius_ = 0;
  std::array<PoseCandidate, kMost> held_;
  std::size_t count_ = 0;
};

/// How far a detection may be believed.
struct Verdict {
  bool certain = false;      ///< nothing but the object scores so high
  bool convincing = false;   ///< as it is
  bool likely = false;       ///< once the descriptors support it
  bool again = false;        ///< once the next picture shows it in the same place
  bool clear = false;        ///< once every keypoint was tried: noise explains it, and nothing else fits
  bool last_resort = false;  ///< once every keypoint was tried and the descriptors support it
};
/// Something plain of the object's size explains the readings better than the object.
[[nodiscard]] bool is_plain(const Detection& detection) noexcept;
/// The verdict cannot be given before the best pose's other attitudes were tried.
[[nodiscard]] bool needs_other_attitudes(const Detection& detection) noexcept;
[[nodiscard]] Verdict verdict_on(const Detection& detection) noexcept;

}  // namespace pliant

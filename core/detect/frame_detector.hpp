// Finds the model in one depth frame without a start pose, in bounded slices: the paper's rigid detection
// (section 3.2) for depth pictures, with poses proposed by local reference frames and by grouping, judged by
// free space.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/camera/surface.hpp"
#include "core/detect/depth_snapshot.hpp"
#include "core/detect/descriptor_match.hpp"
#include "core/detect/fast_transform.hpp"
#include "core/detect/point_grid.hpp"
#include "core/detect/pose_alignment.hpp"
#include "core/detect/pose_candidates.hpp"
#include "core/detect/pose_evidence.hpp"
#include "core/detect/pose_votes.hpp"
#include "core/detect/probe_points.hpp"
#include "core/detect/shot.hpp"
#include "core/detect/uniform_sampling.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"
#include "core/track_settings.hpp"

namespace pliant {

struct DetectSettings {
  std::uint32_t keypoints = 1024;        ///< scene keypoints described in a round [64, 4096]
  std::uint32_t rounds = 3;              ///< rounds of further keypoints until the object is found [1, 8]
  std::uint32_t model_keypoints = 1024;  ///< of the model's, taken from the front [64, 2048]
  bool confirmed = false;     ///< on: who asks believes a weak pose only when the next picture shows it again
  bool thorough = false;      ///< on: every proposal is brought nearer before it is judged, which thin limbs
                              ///< need: for single pictures
  std::uint32_t matches = 4;  ///< model keypoints tried for each scene keypoint [1, 8]
};

enum class DetectState : std::uint8_t {
  idle,     ///< no frame was begun
  working,  ///< call step() again
  found,    ///< best() holds a pose
  nothing   ///< the frame does not show the object, or not clearly
};

class FrameDetector {
 public:
  static constexpr std::size_t kEvidencePoints = 608;
  /// Steps of a round, in order.
  enum class Phase : std::uint8_t {
    normals,
    sample,
    describe,
    match,
    propose,
    narrow,
    vote,
    look,
    shortlist,
    settle,
    challenge
  };

  /// Takes the memory for this model and camera (about 4 MB).
  void lay_out(Workspace& workspace, const ModelView& model, const Intrinsics& camera,
               const DetectSettings& settings) noexcept;
  /// After lay_out() on a real workspace. `model`'s memory must outlive the detector.
  void start(const ModelView& model, const Intrinsics& camera, const SensorDescription& sensor,
             Kernels kernels) noexcept;

  /// Begins a search in `surface`, whose window should be the whole picture. Keeps what it needs: the surface
  /// may change from then on. A search under way is dropped.
  void begin(const Surface& surface) noexcept;
  /// As above, but looks for the object near `pose` (camera <- model) first, within `radius` metres.
  void begin(const Surface& surface, const RigidTransform& pose, double radius) noexcept;

  /// Works on for about `budget` units of about 1000 instructions, at least one slice (at most about 9000
  /// units).
  DetectState step(std::int64_t budget) noexcept;
  [[nodiscard]] DetectState state() const noexcept { return state_; }
  /// What the next slice works on; kept when the search ends.
  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  /// The distinct poses that were looked at closely so far, in no order.
  [[nodiscard]] std::span<const PoseCandidate> candidates() const noexcept { return finalists_.all(); }
  /// Scene keypoints described so far.
  [[nodiscard]] std::size_t keypoints_used() const noexcept { return keypoints_used_; }
  /// About how many instructions the search took so far; the same on every machine.
  [[nodiscard]] std::uint64_t work() const noexcept { return work_; }
  /// The best pose so far; to be believed only in state found.
  [[nodiscard]] const Detection& best() const noexcept { return best_; }

 private:
  struct Proposal {
    std::uint16_t scene = 0;  // keypoint
    std::uint16_t model = 0;
    std::uint16_t draft = 0;  // its place among the poses brought nearer
    float score = 0;
  };
  static constexpr std::size_t kShortlist = 96;  // proposals that are looked at closely
  static constexpr std::size_t kVoted = 384;     // clusters of proposals that are looked at quickly
  static constexpr std::size_t kByVotes = 48;    // of them, at most, for the votes that they got

  void begin_round() noexcept;
  std::int64_t slice() noexcept;
  std::int64_t slice_normals() noexcept;
  std::int64_t slice_sample() noexcept;
  std::int64_t slice_describe() noexcept;
  std::int64_t slice_match() noexcept;
  std::int64_t slice_propose() noexcept;
  std::int64_t slice_narrow() noexcept;
  std::int64_t slice_vote() noexcept;
  std::int64_t slice_look() noexcept;
  std::int64_t slice_shortlist() noexcept;
  std::int64_t slice_settle() noexcept;
  std::int64_t slice_challenge() noexcept;
  void align(std::size_t count, const AlignSchedule& schedule, RigidTransform& pose) noexcept;
  [[nodiscard]] PoseEvidence look_at(const RigidTransform& pose, std::size_t count, double tolerance,
                                     double plain_weight = 1) noexcept;
  [[nodiscard]] RigidTransform pose_of(const Proposal& proposal) const noexcept;
  void fill_shortlist() noexcept;
  void try_pose(const RigidTransform& pose) noexcept;
  void judge(PoseCandidate& candidate, std::size_t count, double floor) noexcept;
  /// The best pose with all that speaks for and against it.
  [[nodiscard]] Detection best_so_far() noexcept;
  void decide(const Detection& best) noexcept;
  /// Enough of this round's keypoints on the posed model have their best match near the right place.
  [[nodiscard]] bool supported(const RigidTransform& pose) const noexcept;

  DetectSettings settings_;
  std::size_t searches_ = 0;  // begun so far
  ModelView model_;
  double leaf_ = 0;                            // spacing of the scene points, metres
  double coarse_ = 0, fine_ = 0, widest_ = 0;  // tolerances, metres
  DepthSnapshot snapshot_;
  ProbePoints probe_;
  UniformSampling sampling_;
  PointGrid grid_;
  ShotDescriber describer_;
  DescriptorMatcher matcher_;

  std::span<Point3f> lattice_points_;  // before sampling
  std::span<Normal16> lattice_normals_;
  std::span<Point3f> points_;  // oriented scene points
  std::span<Normal16> normals_;
  std::span<std::uint32_t> kept_;
  std::span<std::uint32_t> order_;  // keypoints' points, in the order in which they are described
  std::span<Point3f> key_points_;
  std::span<Descriptor> descriptors_;
  std::span<LocalFrame> frames_;
  std::span<Match> matches_;
  std::span<Proposal> proposals_;    // of this round
  std::span<FastTransform> drafts_;  // their poses brought nearer, where the search is thorough
  PoseVotes votes_;                  // on the proposals of all rounds
  PoseCandidates finalists_;         // poses that are refined in full

  DetectState state_ = DetectState::idle;
  Phase phase_ = Phase::normals;
  bool hinted_ = false;
  RigidTransform hint_;
  double hint_radius_ = 0;
  std::uint32_t round_ = 0;
  std::size_t cursor_ = 0;  // within the phase
  std::size_t point_count_ = 0;
  std::size_t order_count_ = 0, order_next_ = 0;
  std::size_t keypoints_used_ = 0;
  std::uint64_t work_ = 0;
  std::size_t key_count_ = 0;  // of this round
  std::size_t proposal_count_ = 0;
  std::size_t judged_count_ = 0;  // of the proposals, the first so many have a score to be shortlisted by
  std::size_t shortlist_count_ = 0;
  std::size_t voted_count_ = 0;
  std::array<std::uint32_t, kVoted> voted_;  // the best-voted poses
  std::array<Proposal, kVoted> looks_;       // a quick look at each; scene: its place in voted_
  std::array<RigidTransform, kShortlist> shortlist_;
  RigidTransform challenge_;    // the best pose, of which other attitudes are tried
  bool challenged_ = false;     // the best pose of this round
  std::size_t challenges_ = 0;  // in this round
  Detection best_;
};

}  // namespace pliant

#include "core/detect/frame_detector.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/seam.hpp"

namespace pliant {

namespace {

constexpr std::size_t kQuickPoints = 64;       // first look at a proposal
constexpr std::size_t kCloseLookPoints = 200;  // second look
constexpr std::size_t kAlignPoints = 400;      // full refinement
constexpr double kPlainWeight =
    0.3;                             // of agreeing with a wall, at the first look: any pose can sink into one
constexpr double kLeastLean = 0.02;  // flatter supports fix no frame: the noise of a fitted normal (2-4°)
                                     // averaged over a support

// What a pose must score, and how far below the best pose elsewhere must stay. Absent objects reach 0.2,
// rarely 0.27, and then in several places; once every keypoint has been tried, a lone pose is believed
// earlier.
constexpr double kCertain = 0.45;
constexpr double kConvincing = 0.28;
constexpr double kLastResort = 0.2;
constexpr double kRivalShare = 0.4;
// Something round lies within the tolerance of much of another round thing, less closely than the object
// itself would (PoseEvidence::unexplained), and in several attitudes. In pictures of clutter the sum of both
// shares is 0.35 to 1; in those of objects, also deformed and real ones, up to 0.28.
constexpr double kMostDoubt = 0.3;
constexpr double kSurelyUnexplained = 0.02;
constexpr double kBeyondDoubt = 0.5;
// What scores so low that clutter reaches it must have the descriptors on its side: of the keypoints that lie
// on the object, so many have their best match near the right place. By chance about one in a hundred has.
constexpr double kLeastSupport = 0.08;
constexpr std::size_t kFewestSupporters = 4;
constexpr double kMostOutside =
    0.4;  // of the facing points; with more out of the picture, only certainty counts

Vector3 to_vector(const Point3f& p) noexcept {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

/// Rows of the frame as a rotation: local <- cloud.
Matrix3 axes_of(const LocalFrame& frame) noexcept {
  Matrix3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = frame.axes[static_cast<std::size_t>(i)] / 16384.0;
  return m;
}

}  // namespace

void FrameDetector::lay_out(Workspace& workspace, const ModelView& model, const Intrinsics& camera,
                            const DetectSettings& settings) noexcept {
  settings_ = settings;
  settings_.keypoints = std::clamp(settings.keypoints, 64U, 4096U);
  settings_.rounds = std::clamp(settings.rounds, 1U, 8U);
  settings_.matches =
      std::clamp(settings.matches, 1U, static_cast<std::uint32_t>(DescriptorMatcher::kMostBest));
  settings_.model_keypoints =
      std::min(settings.model_keypoints, static_cast<std::uint32_t>(model.keypoint_count()));
  snapshot_.lay_out(workspace, camera);
  const Intrinsics reduced = reduced_intrinsics(camera);
  constexpr int kStep = DepthSnapshot::kNormalStep;
  const std::size_t most = static_cast<std::size_t>((reduced.width + kStep - 1) / kStep) *
                           static_cast<std::size_t>((reduced.height + kStep - 1) / kStep);
  sampling_.lay_out(workspace, most);
  grid_.lay_out(workspace, most);
  describer_.lay_out(workspace);
  matcher_.lay_out(workspace, settings_.model_keypoints);
  lattice_points_ = workspace.take<Point3f>(most);
  lattice_normals_ = workspace.take<Normal16>(most);
  points_ = workspace.take<Point3f>(most);
  normals_ = workspace.take<Normal16>(most);
  kept_ = workspace.take<std::uint32_t>(most);
  order_ = workspace.take<std::uint32_t>(most);
  key_points_ = workspace.take<Point3f>(settings_.keypoints);
  descriptors_ = workspace.take<Descriptor>(settings_.keypoints);
  frames_ = workspace.take<LocalFrame>(settings_.keypoints);
  matches_ = workspace.take<Match>(settings_.keypoints * settings_.matches);
  proposals_ = workspace.take<Proposal>(settings_.keypoints * settings_.matches);
}

void FrameDetector::start(const ModelView& model, const Intrinsics& camera, const SensorDescription& sensor,
                          Kernels kernels) noexcept {
  model_ = model;
  snapshot_.start(camera, sensor);
  matcher_.start(kernels);
  matcher_.prepare(model.descriptors().first(settings_.model_keypoints));
  // Ten points across the support's radius tell its shape; more cost time only.
  leaf_ = std::max(model.spacing(), 0.1 * model.header().support_radius);
  // A local frame is off by some degrees: a tenth of a radian at most of the lever counts as agreement at
  // first.
  coarse_ = 0.08 * model.radius();
  // Where the noise is wider than the object's own relief, agreement says nothing.
  widest_ = 0.12 * model.radius();
  fine_ = 0.03 * model.radius();
  state_ = DetectState::idle;
}

void FrameDetector::begin(const Surface& surface) noexcept {
  snapshot_.take(surface);
  hinted_ = false;
  hint_ = RigidTransform();
  phase_ = Phase::normals;
  cursor_ = 0;
  round_ = 0;
  finalist_count_ = 0;
  keypoints_used_ = 0;
  best_ = Detection();
  state_ = DetectState::working;
}

void FrameDetector::begin(const Surface& surface, const RigidTransform& pose, double radius) noexcept {
  begin(surface);
  hinted_ = true;
  hint_ = pose;
  hint_radius_ = radius + model_.radius();
}

DetectState FrameDetector::step(std::int64_t budget) noexcept {
  while (state_ == DetectState::working) {
    budget -= slice();
    if (budget <= 0) break;
  }
  return state_;
}

std::int64_t FrameDetector::slice() noexcept {
  switch (phase_) {
    case Phase::normals:
      return slice_normals();
    case Phase::sample:
      return slice_sample();
    case Phase::describe:
      return slice_describe();
    case Phase::match:
      return slice_match();
    case Phase::propose:
      return slice_propose();
    case Phase::shortlist:
      return slice_shortlist();
    case Phase::settle:
      return slice_settle();
  }
  return 1;
}

std::int64_t FrameDetector::slice_normals() noexcept {
  constexpr int kRows = 8;
  const int first = static_cast<int>(cursor_);
  // Wide enough that σ of the depth tilts the plane by less than a few degrees, narrow against the support.
  const double metres = std::max(leaf_, 0.2 * model_.header().support_radius);
  snapshot_.compute_normals(first, first + kRows, metres);
  cursor_ += kRows;
  if (first + kRows >= snapshot_.lattice_height()) {
    phase_ = Phase::sample;
    cursor_ = 0;
  }
  return snapshot_.lattice_width() * kRows / 2;
}

std::int64_t FrameDetector::slice_sample() noexcept {
  snapshot_.mark_plain(model_.header().support_radius);
  constexpr int kStep = DepthSnapshot::kNormalStep;
  std::size_t count = 0;
  for (int v = 0; v < snapshot_.height(); v += kStep)
    for (int u = 0; u < snapshot_.width(); u += kStep) {
      const Normal16& n = snapshot_.normal(u, v);
      if (n.x == 0 && n.y == 0 && n.z == 0) continue;
      lattice_points_[count] = snapshot_.vertex(u, v);
      lattice_normals_[count++] = n;
    }
  point_count_ = sampling_.sample(lattice_points_.first(count), leaf_, kept_);
  for (std::size_t k = 0; k < point_count_; ++k) {
    points_[k] = lattice_points_[kept_[k]];
    normals_[k] = lattice_normals_[kept_[k]];
  }
  const double support = model_.header().support_radius;
  if (point_count_ < ShotDescriber::kLeastNeighbours ||
      !grid_.build(points_.first(point_count_), grid_cell_for_support(support))) {
    state_ = DetectState::nothing;
    return 1;
  }
  // Keypoints: every point, in an order of which each prefix is spread over the picture: steps of the golden
  // ratio.
  order_count_ = point_count_;
  order_next_ = 0;
  std::size_t stride = point_count_ * 1000 / 1618 + 1;
  const auto divides = [&](std::size_t s) {
    std::size_t a = point_count_, b = s;
    while (b != 0) {
      const std::size_t r = a % b;
      a = b;
      b = r;
    }
    return a != 1;
  };
  while (stride > 1 && divides(stride)) --stride;
  // With a hint, those near it come first.
  const Vector3 centre = hint_ * model_.centre();
  std::size_t placed = 0;
  for (int near = hinted_ ? 1 : 0; near >= 0; --near)
    for (std::size_t k = 0, at = 0; k < point_count_; ++k, at = (at + stride) % point_count_) {
      if (hinted_) {
        const Vector3 apart = to_vector(points_[at]) - centre;
        if ((apart.dot(apart) <= hint_radius_ * hint_radius_) != (near == 1)) continue;
      }
      order_[placed++] = static_cast<std::uint32_t>(at);
    }
  begin_round();
  return static_cast<std::int64_t>(count) / 2 + 1;
}

void FrameDetector::begin_round() noexcept {
  phase_ = Phase::describe;
  cursor_ = 0;
  key_count_ = 0;
}

std::int64_t FrameDetector::slice_describe() noexcept {
  constexpr std::size_t kKeys = 8;
  const OrientedPoints cloud = {points_.first(point_count_), normals_.first(point_count_)};
  for (std::size_t k = 0; k < kKeys && key_count_ < settings_.keypoints && order_next_ < order_count_; ++k) {
    const std::uint32_t i = order_[order_next_++];
    float lean = 0;
    if (!describer_.describe(cloud, grid_, i, model_.header().support_radius, descriptors_[key_count_],
                             frames_[key_count_], &lean) ||
        static_cast<double>(lean) < kLeastLean)
      continue;
    key_points_[key_count_++] = points_[i];
    ++keypoints_used_;
  }
  if (key_count_ == settings_.keypoints || order_next_ == order_count_) {
    phase_ = Phase::match;
    cursor_ = 0;
  }
  return 90 * static_cast<std::int64_t>(kKeys);
}

std::int64_t FrameDetector::slice_match() noexcept {
  const std::size_t group =
      std::min<std::size_t>(2 * kBoundQueries, key_count_ - std::min(cursor_, key_count_));
  matcher_.match(descriptors_.subspan(cursor_, group), settings_.matches,
                 matches_.subspan(cursor_ * settings_.matches));
  for (std::size_t k = cursor_ * settings_.matches; k < (cursor_ + group) * settings_.matches; ++k) {
    proposals_[k].scene = static_cast<std::uint16_t>(k / settings_.matches);
    proposals_[k].model = matches_[k].model;
  }
  cursor_ += group;
  if (cursor_ >= key_count_) {
    phase_ = Phase::propose;
    proposal_count_ = key_count_ * settings_.matches;
    cursor_ = 0;
  }
  return static_cast<std::int64_t>(group * settings_.model_keypoints) / 12 + 1;
}

RigidTransform FrameDetector::pose_of(const Proposal& proposal) const noexcept {
  const Matrix3 rotation =
      axes_of(frames_[proposal.scene]).transpose() * axes_of(model_.frames()[proposal.model]);
  return {rotation,
          to_vector(key_points_[proposal.scene]) - rotation * to_vector(model_.positions()[proposal.model])};
}

std::int64_t FrameDetector::slice_propose() noexcept {
  constexpr std::size_t kBatch = 128;
  const std::size_t last = std::min(cursor_ + kBatch, proposal_count_);
  for (; cursor_ < last; ++cursor_) {
    Proposal& p = proposals_[cursor_];
    p.score = static_cast<float>(
        pose_evidence(model_, snapshot_, pose_of(p), kQuickPoints, coarse_, widest_, kPlainWeight).score());
  }
  if (cursor_ >= proposal_count_) {
    shortlist_count_ = std::min(kShortlist, proposal_count_);
    std::partial_sort(proposals_.begin(), proposals_.begin() + static_cast<std::ptrdiff_t>(shortlist_count_),
                      proposals_.begin() + static_cast<std::ptrdiff_t>(proposal_count_),
                      [](const Proposal& a, const Proposal& b) {
                        if (a.score != b.score) return a.score > b.score;
                        return a.scene != b.scene ? a.scene < b.scene : a.model < b.model;
                      });
    phase_ = Phase::shortlist;
    cursor_ = 0;
    if (hinted_ && round_ == 0) try_pose(hint_);
  }
  return static_cast<std::int64_t>(kBatch) * 8;
}

bool FrameDetector::same_place(const RigidTransform& a, const RigidTransform& b) const noexcept {
  const Vector3 apart = a * model_.centre() - b * model_.centre();
  return apart.dot(apart) < 0.09 * model_.radius() * model_.radius() &&
         cos_angle(a.rotation.transpose() * b.rotation) > 0.9;
}

void FrameDetector::judge(Candidate& candidate, std::size_t count, double floor) const noexcept {
  candidate.evidence = pose_evidence(model_, snapshot_, candidate.pose, count, fine_, widest_);
  candidate.score = candidate.evidence.score();
  candidate.seamless = 0;
  if (candidate.score <= 0 || candidate.score <= floor) return;  // the seam could only lower it
  candidate.seamless = seam_evidence(model_, snapshot_, candidate.pose, kEvidencePoints, 0.5 * fine_).share();
  candidate.score -= candidate.seamless;
}

void FrameDetector::keep(const Candidate& candidate) noexcept {
  // One candidate a place: the better one stays.
  for (std::size_t k = 0; k < finalist_count_; ++k)
    if (same_place(finalists_[k].pose, candidate.pose)) {
      if (candidate.score > finalists_[k].score) finalists_[k] = candidate;
      return;
    }
  if (finalist_count_ < kFinalists) {
    finalists_[finalist_count_++] = candidate;
    return;
  }
  std::size_t worst = 0;
  for (std::size_t k = 1; k < finalist_count_; ++k)
    if (finalists_[k].score < finalists_[worst].score) worst = k;
  if (candidate.score > finalists_[worst].score) finalists_[worst] = candidate;
}

void FrameDetector::try_pose(const RigidTransform& pose) noexcept {
  Candidate candidate;
  candidate.pose = pose;
  refine_pose(model_, snapshot_, kCloseLookPoints, coarse_, fine_, 4, candidate.pose);
  // What scores below every finalist is dropped anyway.
  double floor = 10;
  for (std::size_t k = 0; k < finalist_count_; ++k) floor = std::min(floor, finalists_[k].score);
  judge(candidate, kCloseLookPoints, finalist_count_ == kFinalists ? floor : -10);
  keep(candidate);
}

std::int64_t FrameDetector::slice_shortlist() noexcept {
  if (cursor_ < shortlist_count_) {
    try_pose(pose_of(proposals_[cursor_++]));
  }
  if (cursor_ >= shortlist_count_) {
    phase_ = Phase::settle;
    cursor_ = 0;
  }
  return 300;
}

std::int64_t FrameDetector::slice_settle() noexcept {
  if (cursor_ < finalist_count_) {
    Candidate& candidate = finalists_[cursor_++];
    // The object may have deformed: a pose that fits all of it fairly says that it is there, one that fits
    // its largest rigid part closely says where.
    refine_pose(model_, snapshot_, kAlignPoints, 2 * fine_, 0.5 * fine_, 6, candidate.pose);
    judge(candidate, kEvidencePoints, -10);
    Candidate close = candidate;
    refine_pose(model_, snapshot_, kAlignPoints, fine_, 0.1 * fine_, 8, close.pose);
    judge(close, kEvidencePoints, -10);
    const double score = std::max(candidate.score, close.score);
    if (close.score > 0.5 * candidate.score) candidate = close;
    candidate.score = score;
  }
  if (cursor_ >= finalist_count_) decide();
  return 1500;
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
  best_ = Detection();
  std::size_t first = kFinalists;
  for (std::size_t k = 0; k < finalist_count_; ++k)
    if (first == kFinalists || finalists_[k].score > finalists_[first].score) first = k;
  if (first < kFinalists) {
    best_.pose = finalists_[first].pose;
    best_.score = finalists_[first].score;
    best_.evidence = finalists_[first].evidence;
    best_.seamless = finalists_[first].seamless;
    const double left = best_.evidence.unexplained() + kSurelyUnexplained;
    for (std::size_t k = 0; k < finalist_count_; ++k) {
      const Candidate& other = finalists_[k];
      if (k == first || same_place(other.pose, best_.pose)) continue;
      const Vector3 apart = other.pose * model_.centre() - best_.pose * model_.centre();
      double& against = apart.dot(apart) < model_.radius() * model_.radius() ? best_.twin : best_.rival;
      // What fits less closely speaks less against it.
      const double weight = std::min(1.0, left / (other.evidence.unexplained() + kSurelyUnexplained));
      against = std::max(against, other.score > 0 ? other.score * weight : other.score);
    }
  }
  const bool lone = best_.rival <= kRivalShare * best_.score;
  const bool in_sight = best_.evidence.outside <= kMostOutside * best_.evidence.facing;
  // How much speaks for another thing of a like shape: what noise does not explain, and how well the model
  // fits in another attitude.
  const double doubt =
      best_.evidence.unexplained() + (best_.score > 0 ? std::max(best_.twin, 0.0) / best_.score : 0);
  const bool itself = doubt <= kMostDoubt || best_.score >= kBeyondDoubt;
  const bool convincing =
      itself && (best_.score >= kCertain || (best_.score >= kConvincing && lone && in_sight));
  const bool last = round_ + 1 >= settings_.rounds || order_next_ >= order_count_;
  const bool clear = itself && lone && in_sight;
  const bool last_resort =
      (last || round_ >= 2) && best_.score >= kLastResort && clear && (convincing || supported(best_.pose));
  if ((convincing || last_resort) && (last || !settings_.exhaustive)) {
    state_ = DetectState::found;
  } else if (last) {
    state_ = DetectState::nothing;
  } else {
    ++round_;
    begin_round();
  }
}

}  // namespace pliant

#include "core/detect/frame_detector.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/spread_order.hpp"
#include "core/detect/work.hpp"

namespace pliant {

namespace {

constexpr double kLeastLean = 0.02;  // flatter supports fix no frame: the noise of a fitted normal (2-4°)
                                     // averaged over a support

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
  const std::size_t choices = static_cast<std::size_t>(settings_.keypoints) * settings_.matches;
  matches_ = workspace.take<Match>(choices);
  proposals_ = workspace.take<Proposal>(choices);
  drafts_ = workspace.take<FastTransform>(settings_.thorough ? choices : 0);
  probe_.lay_out(workspace, kEvidencePoints);
  const std::size_t keypoints = static_cast<std::size_t>(settings_.rounds) * settings_.keypoints;
  votes_.lay_out(workspace, keypoints * settings_.matches, keypoints);
}

void FrameDetector::start(const ModelView& model, const Intrinsics& camera, const SensorDescription& sensor,
                          Kernels kernels) noexcept {
  model_ = model;
  snapshot_.start(camera, sensor);
  probe_.start(model);
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
  finalists_.start(model.centre(), model.radius());
  searches_ = 0;
  votes_.start(model.centre(), model.radius());
  state_ = DetectState::idle;
}

void FrameDetector::begin(const Surface& surface) noexcept {
  snapshot_.take(surface);
  hinted_ = false;
  hint_ = RigidTransform();
  phase_ = Phase::normals;
  cursor_ = 0;
  round_ = 0;
  finalists_.clear();
  votes_.clear();
  keypoints_used_ = 0;
  work_ = 0;
  best_ = Detection();
  state_ = DetectState::working;
  ++searches_;
}

void FrameDetector::begin(const Surface& surface, const RigidTransform& pose, double radius) noexcept {
  begin(surface);
  hinted_ = true;
  hint_ = pose;
  hint_radius_ = radius + model_.radius();
}

DetectState FrameDetector::step(std::int64_t budget) noexcept {
  while (state_ == DetectState::working) {
    const std::int64_t took = slice();
    budget -= took;
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
    case Phase::narrow:
      return slice_narrow();
    case Phase::vote:
      return slice_vote();
    case Phase::look:
      return slice_look();
    case Phase::shortlist:
      return slice_shortlist();
    case Phase::settle:
      return slice_settle();
    case Phase::challenge:
      return slice_challenge();
  }
  return 1;
}

std::int64_t FrameDetector::slice_normals() noexcept {
  constexpr int kRows = 8;
  const int first = static_cast<int>(cursor_);
  // Wide enough that σ of the depth tilts the plane by less than a few degrees, narrow against the support.
  const double metres = std::max(leaf_, 0.2 * model_.header().support_radius);
  snapshot_.compute_normals(first, first + kRows, metres);
  work_ += static_cast<std::uint64_t>(snapshot_.lattice_width()) * kRows * work::kLattice;
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
  // ratio. Each search begins beside the last one: where one has missed, the next has other keypoints.
  order_count_ = point_count_;
  order_next_ = 0;
  const SpreadOrder order(point_count_);
  const std::size_t first = searches_ % point_count_;
  // With a hint, those near it come first. Walls and tables come last: they look alike everywhere.
  const Vector3 centre = hint_ * model_.centre();
  const auto turn_of = [&](std::size_t at) {
    const Vector3 apart = to_vector(points_[at]) - centre;
    const bool far = hinted_ && apart.dot(apart) > hint_radius_ * hint_radius_;
    return (far ? 2 : 0) + (normals_[at].pad != 0 ? 1 : 0);
  };
  std::size_t placed = 0;
  for (int turn = 0; turn < 4; ++turn)
    for (std::size_t k = 0, at = first; k < point_count_; ++k, at = order.next(at))
      if (turn_of(at) == turn) order_[placed++] = static_cast<std::uint32_t>(at);
  begin_round();
  return static_cast<std::int64_t>(count) / 2 + 1;
}

void FrameDetector::begin_round() noexcept {
  phase_ = Phase::describe;
  challenged_ = false;
  challenges_ = 0;
  cursor_ = 0;
  key_count_ = 0;
}

std::int64_t FrameDetector::slice_describe() noexcept {
  constexpr std::size_t kKeys = 8;
  const OrientedPoints cloud = {points_.first(point_count_), normals_.first(point_count_)};
  for (std::size_t k = 0; k < kKeys && key_count_ < settings_.keypoints && order_next_ < order_count_; ++k) {
    const std::uint32_t i = order_[order_next_++];
    work_ += work::kPictureDescriptor;
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
  return 70 * static_cast<std::int64_t>(kKeys);
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
  work_ += group * settings_.model_keypoints * work::kComparison;
  cursor_ += group;
  if (cursor_ >= key_count_) {
    phase_ = Phase::propose;
    proposal_count_ = key_count_ * settings_.matches;
    cursor_ = 0;
  }
  return static_cast<std::int64_t>(group * settings_.model_keypoints) / 16 + 1;
}

}  // namespace pliant

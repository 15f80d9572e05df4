#include "core/capture/object_capture.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

constexpr double kNormalSpan = 0.006;       // metres to each side that normals are taken over
constexpr double kLeastAgreement = 0.75;    // of the readings that can be judged
constexpr double kCertainAgreement = 0.92;  // when the object is found again
constexpr std::uint32_t kFewestAgreeing = 120;
constexpr double kTooFarVoxels = 1.5;         // σ beyond so many voxels says nothing of the surface
constexpr double kLeastReadings = 0.15;       // of the picture
constexpr double kBelowTable = 0.008;         // metres of the volume below the table
constexpr std::size_t kTriesToFindAgain = 6;  // kept views

bool usable_size(double size) noexcept {
  return size >= 0.05 && size <= 1.0;
}

}  // namespace

void ObjectCapture::lay_out(Workspace& workspace, const Intrinsics& camera, const VolumePlan& plan) noexcept {
  surface_.lay_out(workspace, camera);
  background_.lay_out(workspace, camera);
  cells_.lay_out(workspace, camera);
  volume_.lay_out(workspace, plan);
  fuser_.lay_out(workspace, camera);
  keyframes_.lay_out(workspace, camera);
  joint_.lay_out(workspace);
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  picture_depth_ = workspace.take<std::uint16_t>(pixels);
  picture_facing_ = workspace.take<std::uint8_t>(pixels);
  points_ = workspace.take<ViewPoint>(kViewPoints);
  rows_ = workspace.take<PlaneRow>(kViewPoints);
}

std::size_t ObjectCapture::workspace_bytes(const Intrinsics& camera, const SensorDescription& sensor,
                                           const CaptureSettings& settings) noexcept {
  ObjectCapture measured;
  Workspace workspace;
  measured.lay_out(workspace, camera, volume_plan(settings, sensor));
  return workspace.used();
}

const char* ObjectCapture::start(const Intrinsics& camera, const SensorDescription& sensor,
                                 const CaptureSettings& settings, std::span<std::byte> block) noexcept {
  if (const char* fault = intrinsics_fault(camera)) return fault;
  if (!usable_size(settings.size)) return "the size is not within 0.05 to 1 m";
  if (settings.voxel != 0 && !(settings.voxel >= 0.0005 && settings.voxel <= 0.02))
    return "the voxel is not within 0.0005 to 0.02 m";
  *this = ObjectCapture();
  camera_ = camera;
  settings_ = settings;
  plan_ = volume_plan(settings, sensor);
  Workspace workspace(block);
  lay_out(workspace, camera, plan_);
  if (workspace.exhausted()) return "the memory block is too small";
  surface_.start(camera, sensor, settings.kernels);
  projector_.start(camera);
  fuser_.start(projector_);
  background_.start(surface_, settings.size);
  cells_.start(settings.clearance);
  volume_.clear();
  normal_span_ = surface_.pixel_span(kNormalSpan).span;
  return nullptr;
}

const CaptureStatus& ObjectCapture::process(const DepthFrame& frame) noexcept {
  known_pose_ = false;
  judge_picture(frame);
  return status_;
}

const CaptureStatus& ObjectCapture::process(const DepthFrame& frame,
                                            const RigidTransform& camera_from_world) noexcept {
  known_pose_ = true;
  given_ = camera_from_world;
  judge_picture(frame);
  return status_;
}

void ObjectCapture::judge_picture(const DepthFrame& frame) noexcept {
  status_ = CaptureStatus();
  status_.frame = frame.number;
  ++figures_.frames;
  surface_.build(frame, {0, 0, camera_.width, camera_.height});
  background_.update(surface_);
  cells_.look(surface_, background_);
  const bool placed = begun_ ? follow() : begin();
  if (!placed) {
    status_.state = begun_ ? CaptureState::lost : CaptureState::waiting;
    figures_.lost += begun_ ? 1 : 0;
    return;
  }
  fuse(frame);
}

RigidTransform ObjectCapture::first_pose(const Target& target) noexcept {
  // Upright: the normal of the plane that the target stands on. Of the planes not far below it that is the
  // one most upright in the picture; where none is (the camera looks straight down), the nearest.
  Vector3 up(0, -1, 0);
  const BackgroundPlane* table = nullptr;
  constexpr std::int32_t kUprightEnough = 16384 / 6;
  const std::size_t sampled = cells_.sample(surface_, normal_span_, points_);
  std::int32_t nearest = plan_.half(), uprightness = kUprightEnough;
  for (const BackgroundPlane& plane : background_.planes()) {
    std::int32_t least = 1 << 20;
    for (std::size_t i = 0; i < sampled; ++i)
      least = std::min(least, plane.height({points_[i].x, points_[i].y, points_[i].z}));
    if (least > plan_.half()) continue;
    const bool upright = -plane.normal.y > uprightness;
    if (!upright && (uprightness > kUprightEnough || least >= nearest)) continue;
    if (upright) uprightness = -plane.normal.y;
    nearest = least;
    table = &plane;
  }
  if (table != nullptr) up = Vector3(table->normal.x, table->normal.y, table->normal.z) / 16384.0;
  up.normalize();
  Vector3 right = Vector3(1, 0, 0) - up.x() * up;
  right.normalize();
  const Vector3 away = up.cross(right);
  // The bounding box along these axes.
  Vector3 low(1e9, 1e9, 1e9), high(-1e9, -1e9, -1e9);
  for (std::size_t i = 0; i < sampled; ++i) {
    const Vector3 p = Vector3(points_[i].x, points_[i].y, points_[i].z) / kUnitsPerMetre;
    const Vector3 q(right.dot(p), away.dot(p), up.dot(p));
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const double half = plan_.half() / kUnitsPerMetre;
  Vector3 middle = 0.5 * (low + high);
  // Where it is larger than the volume, its front middle counts.
  const Vector3 seen = high - low;
  if (seen.maxCoeff() > 2 * half) {
    const Vector3 m = Vector3(target.middle.x, target.middle.y, target.middle.z) / kUnitsPerMetre;
    middle = Vector3(right.dot(m), away.dot(m), up.dot(m));
    status_.too_large = true;
  } else {
    // As deep as it is wide, for all that the first view tells.
    middle.y() = low.y() + 0.5 * std::clamp(seen.x(), seen.y(), 2 * half);
  }
  table_height_ = -2 * half;
  if (table != nullptr) {
    const double plane = table->offset / kUnitsPerMetre;
    middle.z() = std::min(middle.z(), plane + half - kBelowTable);
    if (seen.z() < 2 * half - kBelowTable) middle.z() = plane + half - kBelowTable;
    table_height_ = plane - middle.z();
  }
  RigidTransform pose;
  pose.rotation.col(0) = right;
  pose.rotation.col(1) = away;
  pose.rotation.col(2) = up;
  pose.rotation = orthonormalised(pose.rotation);
  pose.translation = pose.rotation * middle;
  return pose;
}

bool ObjectCapture::begin() noexcept {
  const bool chosen = settings_.at_u >= 0 && settings_.at_v >= 0;
  const Target target =
      cells_.find_target(surface_, background_, chosen ? settings_.at_u : camera_.width / 2,
                         chosen ? settings_.at_v : camera_.height / 2, chosen, settings_.size);
  if (target.cells == 0) {
    std::size_t readings = 0, looked = 0;
    for (int v = 0; v < camera_.height; v += 8)
      for (int u = 0; u < camera_.width; u += 8) {
        ++looked;
        readings += surface_.depth_at(u, v) != 0 ? 1U : 0U;
      }
    status_.too_near = static_cast<double>(readings) < kLeastReadings * static_cast<double>(looked);
    return false;
  }
  pose_ = before_ = first_pose(target);
  if (known_pose_) world_ = given_.inverse() * pose_;
  begun_ = true;
  pose_frame_ = before_frame_ = status_.frame;
  status_.agreement = 1;
  status_.held = 1;
  return true;
}

ViewAlignSettings ObjectCapture::align_settings() const noexcept {
  ViewAlignSettings align;
  align.noise = surface_.sigma(static_cast<std::int32_t>(pose_.translation.z() * kUnitsPerMetre));
  return align;
}

bool ObjectCapture::good(const ViewFit& fit) noexcept {
  return fit.agreeing >= kFewestAgreeing && fit.agreement() >= kLeastAgreement &&
         fit.agreeing * 2 >= fit.fresh;
}

bool ObjectCapture::find_again(std::span<const ViewPoint> points, ViewFit& fit) noexcept {
  // From the last pose and from the latest kept views, each with a reach of some centimetres.
  constexpr double kReach = 0.04;
  const auto kept = keyframes_.all();
  ViewFit best;
  for (std::size_t k = 0; k < std::min(kept.size(), kTriesToFindAgain); ++k) {
    const Keyframe& view = kept[kept.size() - 1 - k];
    RigidTransform pose = k == 0 ? pose_ : view.view.pose;
    if (!align_to_picture(points, view.view, projector_, surface_, kReach, align_settings(), rows_, pose))
      continue;
    const ViewFit tried = align_to_volume(points, volume_, pose, align_settings(), rows_);
    // A thing looks like itself from other sides, too: found again is what fits nearly everywhere.
    const bool certain =
        good(tried) && tried.agreement() >= kCertainAgreement && tried.agreeing >= 3 * tried.fresh;
    if (certain && tried.agreement() * tried.agreeing > best.agreement() * best.agreeing) best = tried;
  }
  if (best.agreeing == 0) return false;
  fit = best;
  return true;
}

bool ObjectCapture::follow() noexcept {
  RigidTransform predicted;
  if (known_pose_) {
    predicted = given_ * world_;
  } else {
    // The object goes on as it went, for the pictures that are missing too, at most three.
    predicted = pose_;
    const auto gap = std::min<std::int64_t>(3, status_.frame - pose_frame_);
    if (pose_frame_ - before_frame_ == 1 && gap >= 1) {
      const RigidTransform motion = pose_ * before_.inverse();
      for (std::int64_t i = 0; i < gap; ++i) predicted = motion * predicted;
      predicted.rotation = orthonormalised(predicted.rotation);
    }
  }
  cells_.take_near(surface_, volume_, FixedPose(predicted.inverse(), Vector3::Zero()));
  const auto points =
      std::span<const ViewPoint>(points_).first(cells_.sample(surface_, normal_span_, points_));
  ViewAlignSettings align = align_settings();
  if (known_pose_) align.iterations = 0;
  ViewFit fit = align_to_volume(points, volume_, predicted, align, rows_);
  if (!known_pose_ && !good(fit)) {
    if (points.empty() || !find_again(points, fit)) {
      status_.too_fast = !points.empty();
      return false;
    }
    status_.too_fast = true;
  }
  status_.agreement = fit.agreement();
  status_.rms = fit.rms;
  status_.held = fit.held;
  status_.featureless = fit.held < fit.needed;
  figures_.featureless += status_.featureless ? 1 : 0;
  before_ = pose_;
  before_frame_ = pose_frame_;
  pose_ = known_pose_ ? predicted : fit.pose;
  pose_frame_ = status_.frame;
  // What moves nearly as far as the distances reach may get lost with the next picture.
  const Vector6 moved = motion_between(pose_, before_, pose_.translation);
  const double per_picture = static_cast<double>(std::max<std::int64_t>(1, pose_frame_ - before_frame_));
  const double reach = plan_.front / kUnitsPerMetre;
  if ((moved.head<3>().norm() * 0.25 * settings_.size + moved.tail<3>().norm()) / per_picture > reach)
    status_.too_fast = true;
  return true;
}

void ObjectCapture::fuse(const DepthFrame& frame) noexcept {
  const FixedPose inverse(pose_.inverse(), Vector3::Zero());
  const std::int32_t gate = std::max(3 * align_settings().noise, 2 * plan_.voxel);
  const bool first = figures_.fused == 0;
  if (!first) cells_.judge(surface_, volume_, inverse, gate);
  const std::uint32_t object = cells_.count(Cell::known) + cells_.count(Cell::fresh);
  status_.against = !first && cells_.count(Cell::against) * 10 > object;
  status_.distance = pose_.translation.norm();
  status_.too_far = align_settings().noise > kTooFarVoxels * plan_.voxel;
  status_.pose = pose_;
  status_.state = CaptureState::capturing;
  if (pose_.translation.norm() + plan_.half() / kUnitsPerMetre * 1.8 > 3.9) return;

  // A margin around the object tells what is free.
  Window window = cells_.window();
  if (window.empty()) return;
  const int margin = 24;
  window = {std::max(0, window.u0 - margin), std::max(0, window.v0 - margin),
            std::min(camera_.width, window.u1 + margin), std::min(camera_.height, window.v1 + margin)};
  picture_.window = window;
  picture_.depth = picture_depth_;
  picture_.facing = picture_facing_;
  take_picture(surface_, cells_.mask(), normal_span_, picture_);
  fuser_.fuse({picture_, pose_, true}, surface_, volume_);
  ++figures_.fused;
  coverage_.add(pose_);
  if (keyframes_.wanted(pose_)) keep(frame);
}

void ObjectCapture::keep(const DepthFrame& frame) noexcept {
  Keyframe& kept = keyframes_.add();
  kept.frame = frame.number;
  kept.view.pose = pose_;
  ViewPicture& picture = kept.view.picture;
  picture.window = shrunk(picture_.window, keyframes_.slot_pixels());
  picture.depth = kept.depth_room;
  picture.facing = kept.facing_room;
  const auto width = static_cast<std::size_t>(picture.width());
  for (int v = picture.window.v0; v < picture.window.v1; ++v) {
    const std::size_t from = picture_.index(picture.window.u0, v), to = picture.index(picture.window.u0, v);
    std::copy_n(picture_.depth.begin() + static_cast<std::ptrdiff_t>(from), width,
                picture.depth.begin() + static_cast<std::ptrdiff_t>(to));
    std::copy_n(picture_.facing.begin() + static_cast<std::ptrdiff_t>(from), width,
                picture.facing.begin() + static_cast<std::ptrdiff_t>(to));
  }
  kept.point_count = cells_.sample(surface_, normal_span_, kept.points);
}

JointFit ObjectCapture::finish() noexcept {
  constexpr double kGate = 0.03;  // metres of drift that are closed
  JointFit fit;
  if (!known_pose_)
    fit = joint_.run(keyframes_.all(), projector_, surface_, align_settings().noise, kGate, rows_);
  // Few views say no more than what was fused already, which holds all pictures.
  constexpr std::size_t kFewViews = 4;
  if (keyframes_.all().size() < kFewViews) return fit;
  volume_.clear();
  for (const Keyframe& kept : keyframes_.all())
    fuser_.fuse({kept.view.picture, kept.view.pose}, surface_, volume_);
  return fit;
}

}  // namespace pliant

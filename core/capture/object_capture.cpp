#include "core/capture/object_capture.hpp"

#include <algorithm>

#include "core/capture/first_view.hpp"
#include "core/capture/view_search.hpp"
#include "core/capture/weak_motions.hpp"

namespace pliant {

namespace {

constexpr double kNormalSpan = 0.006;    // metres to each side that normals are taken over
constexpr double kTooFarVoxels = 1.5;    // σ beyond so many voxels says nothing of the surface
constexpr double kLeastReadings = 0.15;  // of the picture
// Of kSensorFocal's pixels so many say as much as one: the integral of their errors' correlation.
constexpr double kAlikePixels = 35;

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
  if (const char* fault = sensor_fault(sensor)) return fault;
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
  return judge_picture(frame, {GivenPose::Kind::none, {}});
}

const CaptureStatus& ObjectCapture::process(const DepthFrame& frame,
                                            const RigidTransform& camera_from_world) noexcept {
  return judge_picture(frame, {GivenPose::Kind::exact, camera_from_world});
}

const CaptureStatus& ObjectCapture::process_near(const DepthFrame& frame,
                                                 const RigidTransform& camera_from_model) noexcept {
  return judge_picture(frame, {GivenPose::Kind::near, camera_from_model});
}

const CaptureStatus& ObjectCapture::judge_picture(const DepthFrame& frame, const GivenPose& given) noexcept {
  status_ = CaptureStatus();
  status_.frame = frame.number;
  surface_.build(frame, {0, 0, camera_.width, camera_.height});
  if (settings_.separate_views) background_.start(surface_, settings_.size);  // its planes lie elsewhere
  background_.update(surface_);
  cells_.look(surface_, background_);
  const bool placed = begun_ ? follow(given) : begin(given);
  const bool counts = placed || !settings_.separate_views;  // of separate views, poses are tried
  figures_.frames += counts ? 1 : 0;
  if (placed) {
    fuse(frame);
  } else {
    status_.state = begun_ ? CaptureState::lost : CaptureState::waiting;
    figures_.lost += begun_ && counts ? 1 : 0;
  }
  return status_;
}

bool ObjectCapture::begin(const GivenPose& given) noexcept {
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
  const auto points =
      std::span<const ViewPoint>(points_).first(cells_.sample(surface_, normal_span_, points_));
  const FirstView first = place_first_view(points, target, background_.planes(), plan_.half());
  status_.too_large = first.too_large;
  table_height_ = first.table_height;
  trail_.begin(first.pose, status_.frame);
  all_known_ = given.kind == GivenPose::Kind::exact;
  if (all_known_) world_from_model_ = given.pose.inverse() * first.pose;
  begun_ = true;
  status_.agreement = 1;
  status_.held = 1;
  return true;
}

ViewAlignSettings ObjectCapture::align_settings() const noexcept {
  ViewAlignSettings align;
  align.noise = surface_.sigma(static_cast<std::int32_t>(trail_.pose().translation.z() * kUnitsPerMetre));
  return align;
}

void ObjectCapture::judge_hold(const ViewFit& fit, std::span<const ViewPoint> points) noexcept {
  SlipNoise noise;
  noise.sigma = align_settings().noise / kUnitsPerMetre;
  noise.standing = standstill_.share(points, fit.pose);
  const double pixels_of_a_row =
      static_cast<double>(4 * cells_.taken()) / static_cast<double>(std::max<std::size_t>(1, points.size()));
  const double thinned = camera_.fx * camera_.fy / (kSensorFocal * kSensorFocal);
  noise.alike = std::max(1.0, kAlikePixels * thinned / pixels_of_a_row);
  status_.standing = noise.standing;
  status_.featureless = fit.held < needed_share(noise, fit.radius, fit.agreeing);
  figures_.featureless += status_.featureless ? 1 : 0;
  was_held_ = was_held_ || !status_.featureless;
  unheld_ = status_.featureless ? unheld_ + 1 : 0;
  if (was_held_) figures_.longest_unheld = std::max(figures_.longest_unheld, unheld_);
}

bool ObjectCapture::follow(const GivenPose& given) noexcept {
  const bool known = given.kind == GivenPose::Kind::exact, tried = given.kind == GivenPose::Kind::near;
  const RigidTransform predicted = known   ? given.pose * world_from_model_
                                   : tried ? given.pose
                                           : trail_.predict(status_.frame);
  cells_.take_near(surface_, volume_, FixedPose(predicted.inverse(), Vector3::Zero()));
  const auto points =
      std::span<const ViewPoint>(points_).first(cells_.sample(surface_, normal_span_, points_));
  ViewAlignSettings align = align_settings();
  if (known) align.iterations = 0;
  align.stands = !known && standstill_.share(points, predicted) > 0.5;
  ViewFit fit = align_to_volume(points, volume_, predicted, align, rows_);
  if (tried &&
      !(surely_fits(fit) && stands_before(keyframes_.all(), fit.pose, background_.planes(), align.noise)))
    return false;
  if (!known && !tried && !fits(fit)) {
    status_.too_fast = !points.empty();
    const SearchTools tools{volume_, projector_, surface_, align, rows_};
    if (points.empty() || !find_again(points, keyframes_.all(), trail_.pose(), tools, fit)) return false;
  }
  all_known_ = all_known_ && known;
  status_.agreement = fit.agreement();
  status_.rms = fit.rms;
  status_.held = fit.held;
  if (!known) judge_hold(fit, points);
  trail_.add(known ? predicted : fit.pose, status_.frame);
  // What moves nearly as far as the distances reach may get lost with the next picture.
  if (!settings_.separate_views && trail_.moved(0.25 * settings_.size) > plan_.front / kUnitsPerMetre)
    status_.too_fast = true;
  return true;
}

void ObjectCapture::fuse(const DepthFrame& frame) noexcept {
  const RigidTransform& pose = trail_.pose();
  const FixedPose inverse(pose.inverse(), Vector3::Zero());
  const std::int32_t gate = std::max(3 * align_settings().noise, 2 * plan_.voxel);
  const bool first = figures_.fused == 0;
  if (!first) cells_.judge(surface_, volume_, inverse, gate);
  const std::uint32_t object = cells_.count(Cell::known) + cells_.count(Cell::fresh);
  status_.against = !first && cells_.count(Cell::against) * 10 > object;
  status_.distance = pose.translation.norm();
  status_.too_far = align_settings().noise > kTooFarVoxels * plan_.voxel;
  status_.pose = pose;
  status_.state = CaptureState::capturing;
  if (pose.translation.norm() + plan_.half() / kUnitsPerMetre * 1.8 > 3.9) return;

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
  fuser_.fuse({picture_, pose, !settings_.separate_views}, surface_, volume_);
  standstill_.add(pose);
  ++figures_.fused;
  coverage_.add(pose, settings_.separate_views ? Coverage::kEnoughViews : 1);
  if (settings_.separate_views || keyframes_.wanted(pose)) keep(frame);
}

void ObjectCapture::keep(const DepthFrame& frame) noexcept {
  Keyframe& kept = keyframes_.add();
  kept.frame = frame.number;
  kept.view.pose = trail_.pose();
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
  if (!all_known_)
    fit = joint_.run(keyframes_.all(), projector_, surface_, align_settings().noise, kGate, rows_);
  // Few views say no more than what was fused already, which holds all pictures.
  constexpr std::size_t kFewViews = 4;
  if (!settings_.separate_views && keyframes_.all().size() < kFewViews) return fit;
  volume_.clear();
  for (const Keyframe& kept : keyframes_.all())
    fuser_.fuse({kept.view.picture, kept.view.pose}, surface_, volume_);
  return fit;
}

}  // namespace pliant

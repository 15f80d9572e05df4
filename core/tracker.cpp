#include "core/tracker.hpp"

#include <new>

#include "core/tracker_state.hpp"

namespace pliant {

namespace {

/// A followed object may fail this many frames in a row before it is searched for everywhere: it is lost
/// meanwhile.
constexpr int kFramesToReturn = 5;

/// Work of the detector in one frame, in its units of about 1000 instructions: with the surface of a whole
/// picture about as much as two tracked frames.
constexpr std::int64_t kSearchBudget = 50000;
/// Of the same work, what building the surface takes: pixels a unit.
constexpr std::int64_t kPixelsEach = 40;

/// Simulated clutter has fitted to 0.36, real deformed objects from 0.41; what scores higher is taken up at
/// once, the rest when the next search finds it in the same place.
constexpr double kAtOnce = 0.4;

/// How far from its last place a lost object is looked for first: where a hand carries it in half a second.
constexpr double kHintRadius = 0.4;

struct alignas(Workspace::kAlignment) StateStorage {
  std::byte bytes[sizeof(TrackerState)];
};

void done(const TrackerState& s, Stage stage) noexcept {
  if (s.observer.stage_done != nullptr) s.observer.stage_done(s.observer.context, stage);
}

bool usable(const TrackerState& s, const DepthFrame& frame) noexcept {
  return frame.depth != nullptr && frame.width == s.camera.width && frame.height == s.camera.height &&
         frame.stride >= frame.width;
}

/// True for a detection that scores high, or that the search before this one made as well.
bool confirmed(TrackerState& s, const Detection& detection) noexcept {
  const Vector3 place = detection.pose * s.tables.centre;
  const bool again = s.seen_before && (place - s.place_before).norm() < s.model.radius();
  s.place_before = place;
  s.seen_before = true;
  return again || detection.score >= kAtOnce;
}

/// Searches in bounded slices, one a frame: first around the last place, then everywhere. The answer is for
/// an earlier frame; the frame after the last slice brings it forward to itself.
bool search(TrackerState& s, const DepthFrame& frame) noexcept {
  if (s.search == SearchState::found) {
    s.search = SearchState::idle;
    return acquire(s, frame, s.detector.best().pose);
  }
  std::int64_t budget = kSearchBudget;
  if (s.search == SearchState::idle) {
    budget -= static_cast<std::int64_t>(s.camera.width) * s.camera.height / kPixelsEach;
    s.surface.build(frame, {0, 0, s.camera.width, s.camera.height});
    if (s.just_lost)
      s.detector.begin(s.surface, s.regions[0].pose, kHintRadius);
    else
      s.detector.begin(s.surface);
    s.just_lost = false;
    s.search = SearchState::working;
  }
  const DetectState progress = s.detector.step(budget);
  if (progress == DetectState::working) return false;
  const bool found = progress == DetectState::found && confirmed(s, s.detector.best());
  if (progress != DetectState::found || found) s.seen_before = false;
  s.search = found ? SearchState::found : SearchState::idle;
  return false;
}

}  // namespace

void TrackerState::lay_out(Workspace& workspace, const ModelView& model_view,
                           const Intrinsics& intrinsics) noexcept {
  const std::size_t count = model_view.size();
  const auto pixels =
      static_cast<std::size_t>(intrinsics.width) * static_cast<std::size_t>(intrinsics.height);
  tables.lay_out(workspace, count);
  surface.lay_out(workspace, intrinsics);
  points.lay_out(workspace, count);
  last_frame.points.lay_out(workspace, count);
  taken_pixels = workspace.take<std::uint32_t>((pixels + 31) / 32);
  positions = workspace.take<Point3f>(count);
  residuals = workspace.take<float>(count);
  strains = workspace.take<float>(count);
  DetectSettings detect;
  detect.rounds = 1;  // a new picture is worth more than further keypoints of an old one
  detect.confirmed = true;
  detector.lay_out(workspace, model_view, intrinsics, detect);
}

std::size_t Tracker::workspace_bytes(const ModelView& model, const Intrinsics& camera,
                                     const TrackSettings& settings) noexcept {
  (void)settings;
  Workspace measure;
  (void)measure.take<StateStorage>(1);
  TrackerState state;
  state.lay_out(measure, model, camera);
  return measure.used();
}

const char* Tracker::start(const ModelView& model, const Intrinsics& camera, const SensorDescription& sensor,
                           const TrackSettings& settings, std::span<std::byte> block) noexcept {
  state_ = nullptr;
  if (model.empty()) return "there is no model";
  if (const char* fault = intrinsics_fault(camera)) return fault;
  if (const char* fault = sensor_fault(sensor)) return fault;
  if (model.header().highest[0] - model.header().lowest[0] > 2 * limits::kMaxModelHalfExtent ||
      model.header().highest[1] - model.header().lowest[1] > 2 * limits::kMaxModelHalfExtent ||
      model.header().highest[2] - model.header().lowest[2] > 2 * limits::kMaxModelHalfExtent)
    return "the model is larger than 4 m; was it built with --units mm?";
  if (settings.max_regions < 1 || settings.max_regions > limits::kMaxRegions)
    return "max_regions must be 1 to 8";
  if (settings.material != TrackSettings::kAsInModel && !(settings.material >= 0 && settings.material <= 1))
    return "material must be 0 to 1";
  Workspace workspace(block);
  const std::span<StateStorage> storage = workspace.take<StateStorage>(1);
  if (storage.empty()) return "the tracker's block of memory is too small";
  auto* s = new (storage.data()) TrackerState();  // placement: no heap
  s->lay_out(workspace, model, camera);
  if (workspace.exhausted()) return "the tracker's block of memory is too small";
  s->model = model;
  s->camera = camera;
  s->sensor = sensor;
  s->settings = settings;
  if (settings.material == TrackSettings::kAsInModel) s->settings.material = model.material();
  s->tables.start(s->model);
  s->surface.start(camera, sensor, settings.kernels, settings.steps.input_filter);
  s->projector.start(camera);
  s->tolerance = {&s->surface, s->tables.spacing};
  s->patches.start(s->model);
  s->points.reset();
  s->points.add_rows = add_moment_rows(simd_body(settings.kernels));
  s->detector.start(s->model, camera, sensor, settings.kernels);
  state_ = s;
  return nullptr;
}

const TrackResult& Tracker::process(const DepthFrame& frame) noexcept {
  TrackerState& s = *state_;
  s.result = TrackResult();
  s.result.utime = frame.utime;
  s.result.frame = frame.number;
  s.result.state = s.was_tracked ? TrackState::lost : TrackState::searching;
  s.result.frame_used = usable(s, frame);
  if (!s.result.frame_used) return s.result;

  bool tracked = false;
  if (s.following) {
    remember_last_frame(s);
    predict_regions(s);
    done(s, Stage::predict);
    observe_surface(s, frame);  // vertices and normals of the predicted window
    done(s, Stage::surface);
    align_regions(s);  // correspondences and a rigid transform for every region
    warp_surface(s);   // springs carry what moves otherwise to the surface
    regain_base(s);    // where most of the object moved on, the base goes along
    done(s, Stage::deform);
    label_points(s);  // the inlier test
    done(s, Stage::label);
    regroup_outliers(s);  // the same again on the outliers: a chain of rigid transforms
    done(s, Stage::regroup);
    match_deformed(s);  // what is left: a radius search
    weigh_strain(s);
    done(s, Stage::deform);
    tracked = judge(s);
    s.frames_failed = tracked ? 0 : s.frames_failed + 1;
    if (!tracked) return_to_last_frame(s);
    if (s.frames_failed > kFramesToReturn) {
      s.following = false;
      s.just_lost = true;
    }
  } else {
    tracked = search(s, frame);
    done(s, Stage::detect);
    s.following = tracked;
    s.frames_failed = 0;
  }
  if (tracked) publish_tracked(s);
  return s.result;
}

void Tracker::observe(const StageObserver& observer) noexcept {
  state_->observer = observer;
}

void Tracker::set_work_level(double level) noexcept {
  state_->work_level = !(level > 0) ? 0 : level > 1 ? 1 : level;
}

void Tracker::start_from(const RigidTransform& pose) noexcept {
  TrackerState& s = *state_;
  take_up(s, pose);
  s.following = true;
  s.search = SearchState::idle;
  s.just_lost = s.seen_before = false;
  s.frames_failed = 0;
}

void Tracker::reset() noexcept {
  state_->following = false;
  state_->search = SearchState::idle;
  state_->just_lost = false;
  state_->seen_before = false;
  state_->was_tracked = false;
}

}  // namespace pliant

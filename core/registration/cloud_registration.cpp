#include "core/registration/cloud_registration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "core/registration/cloud_chain.hpp"
#include "core/registration/depth_search.hpp"
#include "core/registration/registration_state.hpp"
#include "core/registration/scene_features.hpp"

namespace pliant {

namespace {

// An object seen from one side or among clutter stays between these; a wrong unit (mm for m) does not.
constexpr double kLeastRatio = 0.1, kMostRatio = 60;
// A pose must have this share of the model's points on the scene's surface, with its normals. Absent objects
// reach 0.36; what is seen from one side only is judged by free space instead.
constexpr double kConvincingShare = 0.42;
// Of a cloud taken from one place, nearly all points are in sight from there.
constexpr double kOneView = 0.95;

/// Keypoints after every step of the sampling factor (−20 % each, so about 1.56 times as many).
std::size_t key_capacity(std::size_t scene_points, const RegistrationSettings& settings) noexcept {
  double keys = 1.1 * settings.scene_keypoints;
  for (std::uint32_t step = 0; step < settings.sampling_steps; ++step) keys *= 1.5625;
  return std::min({static_cast<std::size_t>(keys) + 64, scene_points, std::size_t{65535}});
}

RegistrationSettings clamped(const RegistrationSettings& given, const ModelView& model) noexcept {
  RegistrationSettings s = given;
  s.model_keypoints = std::clamp(s.model_keypoints, 32U, static_cast<std::uint32_t>(limits::kMaxModelPoints));
  s.model_keypoints = std::min(s.model_keypoints, static_cast<std::uint32_t>(model.size()));
  s.scene_keypoints = std::clamp(s.scene_keypoints, 32U, 65535U);
  s.sampling_steps = std::min(s.sampling_steps, 8U);
  s.max_regions = std::clamp(s.max_regions, 1U, static_cast<std::uint32_t>(limits::kMaxRegions));
  s.max_instances =
      std::clamp(s.max_instances, 1U, static_cast<std::uint32_t>(CloudRegistration::kMostInstances));
  s.wanted_share = std::clamp(s.wanted_share, 0.1, 1.0);
  return s;
}

void lay_out(Workspace& workspace, const ModelView& model, std::size_t scene_points,
             const RegistrationSettings& given, RegistrationState& s) noexcept {
  s.settings = clamped(given, model);
  s.model = model;
  const std::size_t n = scene_points, m = model.size(), keys = key_capacity(n, s.settings);
  s.base = workspace.take<Point3f>(n);
  s.base_index = workspace.take<std::uint32_t>(n);
  s.base_taken = workspace.take<std::uint8_t>(n);
  s.working = workspace.take<Point3f>(n);
  s.working_normals = workspace.take<Normal16>(n);
  s.working_taken = workspace.take<std::uint8_t>(n);
  s.scratch = workspace.take<float>(std::max(n, m));
  s.kept = workspace.take<std::uint32_t>(n);
  s.base_grid.lay_out(workspace, n);
  s.working_grid.lay_out(workspace, n);
  s.sampling.lay_out(workspace, n);
  s.orientation.lay_out(workspace, n);
  s.keys = workspace.take<Point3f>(keys);
  s.key_descriptors = workspace.take<Descriptor>(keys);
  s.key_frames = workspace.take<LocalFrame>(keys);
  s.matches = workspace.take<Match>(keys);
  s.posed = workspace.take<PosedMatch>(keys);
  s.posed_left = workspace.take<PosedMatch>(keys);
  const std::size_t own =
      s.settings.model_keypoints > model.keypoint_count() ? s.settings.model_keypoints : 0;
  s.own_descriptors = workspace.take<Descriptor>(own);
  s.own_frames = workspace.take<LocalFrame>(own);
  s.model_grid.lay_out(workspace, own > 0 ? m : 0);
  s.describer.lay_out(workspace);
  s.matcher.lay_out(workspace, s.settings.model_keypoints);
  s.grouping.lay_out(workspace, keys);
  s.islands.lay_out(workspace, m);
  s.readings.lay_out(workspace, m);
  s.model_index.lay_out(workspace, m);
  s.prefix = workspace.take<std::uint16_t>(m);
  s.part = workspace.take<std::uint16_t>(m);
  s.open = workspace.take<std::uint8_t>(m);
  s.off = workspace.take<float>(m);
  s.gap_nearest = workspace.take<std::uint32_t>(m);
  s.proposal = workspace.take<std::uint32_t>(m);
  s.claimed = workspace.take<std::uint32_t>(n);
  s.picture = workspace.take<std::uint16_t>(n);
  s.picture_points = workspace.take<Point3f>(n);
  s.depth_block = workspace.take<std::byte>(depth_search_bytes(model, n));
  for (std::uint32_t k = 0; k < s.settings.max_instances; ++k) {
    InstanceBuffers& b = s.buffers[k];
    const std::span<std::byte> regions =
        workspace.take<std::byte>(limits::kMaxRegions * sizeof(RegionResult));
    if (!regions.empty()) {
      auto* first = static_cast<RegionResult*>(static_cast<void*>(regions.data()));
      for (int r = 0; r < limits::kMaxRegions; ++r) new (first + r) RegionResult();
      b.regions = {first, static_cast<std::size_t>(limits::kMaxRegions)};
    }
    b.positions = workspace.take<Point3f>(m);
    b.labels = workspace.take<std::int8_t>(m);
    b.matches = workspace.take<std::int32_t>(m);
    b.residuals = workspace.take<float>(m);
  }
}

/// What to say when a scene is of no use, or `found` when it may be searched.
RegistrationOutcome examine(RegistrationState& s, std::span<const Point3f> scene) noexcept {
  if (scene.size() > s.base.size()) return RegistrationOutcome::too_many_points;
  // Extent: from the 2nd to the 98th hundredth of each coordinate, so that strays do not count.
  double square = 0, flattest = 1e300;
  std::size_t finite = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t count = 0;
    for (const Point3f& p : scene) {
      const float sum = p.x - p.x + (p.y - p.y) + (p.z - p.z);
      if (sum == 0) s.scratch[count++] = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    }
    finite = count;
    if (count == 0) return RegistrationOutcome::no_points;
    float* first = s.scratch.data();
    float* last = first + count;
    float* low = first + count / 50;
    float* high = first + (count - 1 - count / 50);
    std::nth_element(first, low, last);
    const double a = static_cast<double>(*low);
    std::nth_element(first, high, last);
    const double extent = static_cast<double>(*high) - a;
    square += extent * extent;
    flattest = std::min(flattest, extent);
  }
  if (finite < ShotDescriber::kLeastNeighbours) return RegistrationOutcome::too_few_points;
  const ModelHeader& h = s.model.header();
  double model_square = 0;
  for (int axis = 0; axis < 3; ++axis)
    model_square += (h.highest[axis] - h.lowest[axis]) * (h.highest[axis] - h.lowest[axis]);
  s.result.size_ratio = std::sqrt(square / model_square);
  if (square == 0) return RegistrationOutcome::flat;
  if (s.result.size_ratio < kLeastRatio || s.result.size_ratio > kMostRatio)
    return RegistrationOutcome::wrong_size;
  return RegistrationOutcome::found;
}

}  // namespace

const char* describe(RegistrationOutcome outcome) noexcept {
  switch (outcome) {
    case RegistrationOutcome::found:
      return "found";
    case RegistrationOutcome::not_found:
      return "the scene does not show the object, or not clearly";
    case RegistrationOutcome::no_points:
      return "the scene has no finite point";
    case RegistrationOutcome::too_few_points:
      return "the scene has too few points to describe any shape";
    case RegistrationOutcome::flat:
      return "the scene is flat: a plane, a line or a single point looks alike everywhere";
    case RegistrationOutcome::wrong_size:
      return "the scene's size does not fit the model's: are both in the same unit?";
    case RegistrationOutcome::too_many_points:
      return "the scene has more points than were planned for";
  }
  return "unknown";
}

std::size_t CloudRegistration::workspace_bytes(const ModelView& model, std::size_t scene_points,
                                               const RegistrationSettings& settings) noexcept {
  Workspace measure;
  static_cast<void>(measure.take<std::byte>(sizeof(RegistrationState)));
  RegistrationState unused;
  lay_out(measure, model, scene_points, settings, unused);
  return measure.used();
}

const char* CloudRegistration::start(const ModelView& model, std::size_t scene_points,
                                     const RegistrationSettings& settings,
                                     std::span<std::byte> block) noexcept {
  state_ = nullptr;
  if (model.empty()) return "no model";
  Workspace workspace(block);
  const std::span<std::byte> room = workspace.take<std::byte>(sizeof(RegistrationState));
  if (room.empty()) return "the memory block is smaller than workspace_bytes()";
  auto* state = new (room.data()) RegistrationState();  // placement: no heap
  lay_out(workspace, model, scene_points, settings, *state);
  if (workspace.exhausted()) return "the memory block is smaller than workspace_bytes()";
  state_ = state;
  state->matcher.start(state->settings.kernels);
  state->support = model.header().support_radius;
  if (!state->model_index.build(model.positions(), 1.5 * model.spacing())) return "the model has no spacing";
  for (std::size_t i = 0; i < model.size(); ++i) state->prefix[i] = static_cast<std::uint16_t>(i);
  return nullptr;
}

void CloudRegistration::done(RegistrationStage stage, bool model_side) const noexcept {
  if (observer_.stage_done != nullptr) observer_.stage_done(observer_.context, stage, model_side);
}

std::size_t CloudRegistration::prepare(std::span<const Point3f> scene) noexcept {
  RegistrationState& s = *state_;
  s.result = RegistrationResult();
  s.key_count = 0;
  s.result.outcome = examine(s, scene);
  if (s.result.outcome != RegistrationOutcome::found) return 0;
  thin_scene(s, scene);
  if (scene_is_flat(s)) {
    s.result.outcome = RegistrationOutcome::flat;
    return 0;
  }
  find_normals(s);
  for (std::size_t i = 0; i < s.base_count; ++i) s.base_taken[i] = 0;
  for (std::size_t i = 0; i < s.working_count; ++i) s.working_taken[i] = 0;
  s.result.outcome = RegistrationOutcome::not_found;
  return s.base_count;
}

void CloudRegistration::complete(std::size_t number, const RigidTransform& pose, double score) noexcept {
  RegistrationState& s = *state_;
  InstanceResult& instance = s.instances[number];
  instance = InstanceResult();
  instance.score = score;
  build_chain(s, pose, s.buffers[number], instance);
  done(RegistrationStage::chain);
  find_deformed(s, s.buffers[number], instance);
  done(RegistrationStage::deformed);
}

const RegistrationResult& CloudRegistration::finish(std::size_t found) noexcept {
  RegistrationState& s = *state_;
  s.result.model_keypoints = static_cast<std::uint32_t>(s.model_key_count);
  s.result.scene_keypoints = static_cast<std::uint32_t>(s.key_count);
  s.result.instances = {s.instances.data(), found};
  if (found > 0) s.result.outcome = RegistrationOutcome::found;
  return s.result;
}

const RegistrationResult& CloudRegistration::register_cloud(std::span<const Point3f> scene) noexcept {
  RegistrationState& s = *state_;
  // Model initialisation (3.1): stored in the model unless more keypoints are asked for.
  describe_model(s);
  done(RegistrationStage::descriptors, true);
  // Scene: normals, uniform downsampling, descriptors, matches.
  DepthFrame frame;
  Intrinsics camera;
  RigidTransform scene_from_camera;
  s.eye = s.settings.viewpoint;  // the origin unless given: clouds of one sensor stand in its own frame
  const double in_sight = draw_cloud(s, scene, frame, camera, scene_from_camera);
  s.one_view = s.settings.has_viewpoint || in_sight > kOneView;
  if (prepare(scene) == 0) return s.result;
  done(RegistrationStage::normals);
  std::size_t found = 0;
  if (s.one_view && in_sight > 0 && s.settings.free_space) {
    found = search_one_view(frame, camera, scene_from_camera);
    if (in_sight > kOneView) return finish(found);
  }
  std::uint32_t wanted = s.settings.scene_keypoints;
  for (std::uint32_t step = 0; step <= s.settings.sampling_steps && found == 0; ++step) {
    const std::size_t before = s.key_count;
    sample_keypoints(s, wanted);
    done(RegistrationStage::keypoints);
    if (step > 0 && s.key_count <= before) break;  // the scene has no more points
    describe_keypoints(s);
    done(RegistrationStage::descriptors);
    match_keypoints(s);
    done(RegistrationStage::matching);
    // Grouping (3.2): one instance after the other, each from the matches that the earlier ones leave.
    while (found < s.settings.max_instances) {
      RigidTransform pose;
      const double score = find_instance(s, pose);
      done(RegistrationStage::grouping);
      if (score < kConvincingShare) break;
      complete(found++, pose, score);
    }
    wanted = static_cast<std::uint32_t>(std::min(1.5625 * wanted, 65535.0));
  }
  return finish(found);
}

std::size_t CloudRegistration::search_one_view(const DepthFrame& frame, const Intrinsics& camera,
                                               const RigidTransform& scene_from_camera) noexcept {
  RegistrationState& s = *state_;
  SensorDescription sensor;
  sensor.near_limit = 0.05;
  sensor.far_limit = limits::kMaxDepth;
  std::array<SeenInstance, kMostInstances> seen;
  const std::size_t count = search_picture(s, frame, camera, sensor, {seen.data(), s.settings.max_instances});
  done(RegistrationStage::grouping);
  for (std::size_t k = 0; k < count; ++k) complete(k, scene_from_camera * seen[k].pose, seen[k].score);
  return count;
}

const RegistrationResult& CloudRegistration::register_depth(const DepthFrame& frame, const Intrinsics& camera,
                                                            const SensorDescription& sensor) noexcept {
  RegistrationState& s = *state_;
  const std::size_t pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  if (pixels > s.picture_points.size() || frame.width != camera.width || frame.height != camera.height) {
    s.result = RegistrationResult();
    s.result.outcome = RegistrationOutcome::too_many_points;
    return s.result;
  }
  describe_model(s);
  done(RegistrationStage::descriptors, true);
  std::array<SeenInstance, kMostInstances> seen;
  const std::size_t count = search_picture(s, frame, camera, sensor, {seen.data(), s.settings.max_instances});
  done(RegistrationStage::grouping);
  // The picture's readings as a cloud, for the chain and the deformed points.
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const double scale = 1.0 / camera.depth_scale;
  for (int v = 0; v < frame.height; ++v)
    for (int u = 0; u < frame.width; ++u) {
      const std::size_t at = static_cast<std::size_t>(v * frame.width + u);
      const double z = frame.depth[v * frame.stride + u] * scale;
      if (z < sensor.near_limit || z > sensor.far_limit) {
        s.picture_points[at] = {kNone, kNone, kNone};
        continue;
      }
      s.picture_points[at] = {static_cast<float>((u - camera.cx) / camera.fx * z),
                              static_cast<float>((v - camera.cy) / camera.fy * z), static_cast<float>(z)};
    }
  s.one_view = true;
  s.eye = Vector3::Zero();
  const std::size_t keys = s.key_count;
  if (prepare(s.picture_points.first(pixels)) == 0) return s.result;
  done(RegistrationStage::normals);
  s.key_count = keys;
  for (std::size_t k = 0; k < count; ++k) complete(k, seen[k].pose, seen[k].score);
  return finish(count);
}

}  // namespace pliant

#include "core/registration/cloud_registration.hpp"
#include "core/memory/row_major.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "core/registration/cloud_chain.hpp"
#include "core/registration/deformed_search.hpp"
#include "core/registration/depth_search.hpp"
#include "core/registration/instance_search.hpp"
#include "core/registration/registration_layout.hpp"
#include "core/registration/registration_state.hpp"
#include "core/registration/scene_examination.hpp"
#include "core/registration/scene_features.hpp"

namespace pliant {

namespace {

// Of a cloud taken from one place, nearly all points are in sight from there.
constexpr double kOneView = 0.95;
// Keypoints described in all steps together, of those asked for: room for one step of −20 % (1 + 1.56), and
// for more where the scene is too small to yield what was asked for.
constexpr double kMostWork = 2.65;
// Around an instance found in a picture, this many model radii may hold parts of it, moved or deformed.
constexpr double kReach = 1.6;

constexpr std::size_t kEnoughReadings = 16384;

/// Every n-th of the finite points, moved to the front.
std::span<const Point3f> some_readings(std::span<Point3f> points) noexcept {
  std::size_t count = 0;
  for (const Point3f& p : points)
    if (p.x == p.x) points[count++] = p;
  const std::size_t step = count / kEnoughReadings + 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; i += step) points[kept++] = points[i];
  return points.first(kept);
}

/// No instance holds any of it.
void free_scene(RegistrationState& s) noexcept {
  for (std::size_t i = 0; i < s.base_count; ++i) s.base_taken[i] = 0;
  for (std::size_t i = 0; i < s.working_count; ++i) s.working_taken[i] = 0;
}

/// The share of the model that the regions of a chain explain.
double explained_share(const RegistrationState& s, const InstanceBuffers& buffers) noexcept {
  const auto explained = std::count_if(buffers.labels.begin(), buffers.labels.end(),
                                       [](std::int8_t label) noexcept { return label >= 0; });
  return static_cast<double>(explained) / static_cast<double>(s.model.size());
}

}  // namespace

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
  state->warp.start(state->model);
  for (std::size_t i = 0; i < model.size(); ++i) state->prefix[i] = static_cast<std::uint16_t>(i);
  return nullptr;
}

void CloudRegistration::done(RegistrationStage stage, bool model_side) const noexcept {
  if (observer_.stage_done != nullptr) observer_.stage_done(observer_.context, stage, model_side);
}

bool CloudRegistration::inspect(std::span<const Point3f> scene) noexcept {
  RegistrationState& s = *state_;
  s.result = RegistrationResult();
  s.key_count = s.posed_count = 0;
  s.result.outcome = examine(s, scene);
  if (s.result.outcome != RegistrationOutcome::found) return false;
  thin_scene(s, scene);
  s.result.outcome = scene_is_flat(s) ? RegistrationOutcome::flat : RegistrationOutcome::not_found;
  return s.result.outcome != RegistrationOutcome::flat;
}

void CloudRegistration::prepare() noexcept {
  RegistrationState& s = *state_;
  find_normals(s);
  free_scene(s);
  done(RegistrationStage::normals);
}

bool CloudRegistration::complete(std::size_t number, const RigidTransform& pose, double score,
                                 double least_explained) noexcept {
  RegistrationState& s = *state_;
  InstanceResult& instance = s.instances[number];
  instance = InstanceResult();
  instance.score = score;
  build_chain(s, pose, s.buffers[number], instance);
  done(RegistrationStage::chain);
  if (explained_share(s, s.buffers[number]) < least_explained) return false;
  find_deformed(s, s.buffers[number], instance);
  done(RegistrationStage::deformed);
  return true;
}

const RegistrationResult& CloudRegistration::finish(std::size_t found) noexcept {
  RegistrationState& s = *state_;
  s.result.model_keypoints = static_cast<std::uint32_t>(s.model_key_count);
  s.result.scene_keypoints = static_cast<std::uint32_t>(s.key_count);
  s.result.instances = {s.instances.data(), found};
  s.result.work = s.work;
  if (found > 0) s.result.outcome = RegistrationOutcome::found;
  return s.result;
}

const RegistrationResult& CloudRegistration::register_cloud(std::span<const Point3f> scene) noexcept {
  RegistrationState& s = *state_;
  // Model initialisation (3.1): stored in the model unless more keypoints are asked for.
  describe_model(s);
  done(RegistrationStage::descriptors, true);
  s.work = 0;
  // Scene: normals, uniform downsampling, descriptors, matches.
  DepthFrame frame;
  Intrinsics camera;
  RigidTransform scene_from_camera;
  s.eye = s.settings.viewpoint;  // the origin unless given: clouds of one sensor stand in its own frame
  const double in_sight = draw_cloud(s, scene, frame, camera, scene_from_camera);
  s.one_view = s.settings.has_viewpoint || in_sight > kOneView;
  if (!inspect(scene)) return s.result;
  prepare();
  std::size_t found = 0;
  if (s.one_view && in_sight > 0 && s.settings.free_space) {
    found = search_one_view(frame, camera, scene_from_camera);
    if (in_sight > kOneView) return finish(found);
  }
  std::uint32_t wanted = s.settings.scene_keypoints;
  std::size_t described = 0;
  for (std::uint32_t step = 0; step <= s.settings.sampling_steps && found == 0; ++step) {
    // A scene without the object must not take several times as long as one with it.
    if (step > 0 && static_cast<double>(described + wanted) > kMostWork * s.settings.scene_keypoints) break;
    const std::size_t before = s.key_count;
    sample_keypoints(s, wanted);
    described += s.key_count;
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
      const bool doubtful = score < kConvincingShare;
      if (score < kDoubtfulShare || (doubtful && found > 0)) break;
      if (!complete(found, pose, score, doubtful ? kExplainedShare : 0)) {
        free_scene(s);
        break;
      }
      ++found;
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
  const std::size_t count =
      search_picture(s, frame, camera, sensor, observer_, {seen.data(), s.settings.max_instances});
  done(RegistrationStage::grouping);
  for (std::size_t k = 0; k < count; ++k)
    static_cast<void>(complete(k, scene_from_camera * seen[k].pose, seen[k].score));
  return count;
}

void CloudRegistration::read_points(const DepthFrame& frame, const Intrinsics& camera,
                                    const SensorDescription& sensor,
                                    std::span<const SeenInstance> seen) noexcept {
  RegistrationState& s = *state_;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const double scale = 1.0 / camera.depth_scale;
  const double square = kReach * kReach * s.model.radius() * s.model.radius();
  for (int v = 0; v < frame.height; ++v)
    for (int u = 0; u < frame.width; ++u) {
      Point3f& point = s.picture_points[row_major(v, frame.width, u)];
      point = {kNone, kNone, kNone};
      const double z = frame.depth[v * frame.stride + u] * scale;
      if (z < sensor.near_limit || z > sensor.far_limit) continue;
      const Vector3 at((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z);
      bool wanted = seen.empty();
      for (const SeenInstance& instance : seen) {
        const Vector3 apart = at - instance.pose * s.model.centre();
        wanted = wanted || apart.dot(apart) < square;
      }
      if (wanted) point = to_point(at);
    }
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
  s.work = 0;
  std::array<SeenInstance, kMostInstances> seen;
  const std::size_t count =
      search_picture(s, frame, camera, sensor, observer_, {seen.data(), s.settings.max_instances});
  done(RegistrationStage::grouping);
  read_points(frame, camera, sensor, {seen.data(), count});
  s.one_view = true;
  s.eye = Vector3::Zero();
  const std::size_t keys = s.key_count;
  const std::span<Point3f> points = s.picture_points.first(pixels);
  if (count == 0) {
    // Perhaps the picture says why: some of its readings are enough for that.
    static_cast<void>(inspect(some_readings(points)));
    done(RegistrationStage::normals);
    s.key_count = keys;
    return s.result.outcome == RegistrationOutcome::not_found ? finish(0) : s.result;
  }
  s.result = RegistrationResult();
  thin_scene(s, points);
  prepare();
  s.posed_count = 0;  // pictures are not matched by groups
  s.key_count = keys;
  for (std::size_t k = 0; k < count; ++k) static_cast<void>(complete(k, seen[k].pose, seen[k].score));
  return finish(count);
}

}  // namespace pliant

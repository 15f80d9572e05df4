#include "core/registration/depth_search.hpp"
#include "core/memory/row_major.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/frame_detector.hpp"

namespace pliant {

namespace {

// Further instances must be surer than a lone one: they have no place to themselves.
constexpr double kFurtherInstance = 0.35;
constexpr double kDrawnUnitsPerMetre = 8000;  // of drawn pictures: 1/8 mm

Intrinsics usual_camera(std::size_t pixels) noexcept {
  Intrinsics camera;
  const double height = std::sqrt(0.75 * static_cast<double>(pixels));
  camera.height = std::max(limits::kMinFrameHeight, static_cast<int>(height));
  camera.width = std::max(limits::kMinFrameWidth, static_cast<int>(4 * height / 3));
  camera.fx = camera.fy = camera.width;
  return camera;
}

void lay_out(Workspace& workspace, const RegistrationState& s, const Intrinsics& camera, Surface& surface,
             FrameDetector& detector) noexcept {
  DetectSettings settings;
  // There is no next frame to try.
  settings.rounds = 5;
  settings.model_keypoints = 2048;
  settings.exhaustive = s.settings.max_instances > 1;
  surface.lay_out(workspace, camera);
  detector.lay_out(workspace, s.model, camera, settings);
}

}  // namespace

std::size_t depth_search_bytes(const ModelView& model, std::size_t pixels) noexcept {
  // A picture of unusual proportions takes somewhat more than the usual one.
  RegistrationState s;
  s.model = model;
  Workspace measure;
  Surface surface;
  FrameDetector detector;
  lay_out(measure, s, usual_camera(pixels), surface, detector);
  return measure.used() + measure.used() / 4 + 65536;
}

std::size_t search_picture(RegistrationState& s, const DepthFrame& frame, const Intrinsics& camera,
                           const SensorDescription& sensor, std::span<SeenInstance> seen) noexcept {
  Workspace workspace(s.depth_block);
  Surface surface;
  FrameDetector detector;
  lay_out(workspace, s, camera, surface, detector);
  if (workspace.exhausted()) return 0;
  surface.start(camera, sensor, s.settings.kernels);
  detector.start(s.model, camera, sensor, s.settings.kernels);
  surface.build(frame, {0, 0, camera.width, camera.height});
  detector.begin(surface);
  while (detector.state() == DetectState::working) detector.step(1000000);
  s.key_count = detector.keypoints_used();
  if (detector.state() != DetectState::found || seen.empty()) return 0;
  const Detection& best = detector.best();
  seen[0] = {best.pose, best.score};
  std::size_t count = 1;
  // The others by falling score, each with a place of its own.
  while (count < seen.size()) {
    const FrameDetector::Candidate* next = nullptr;
    for (const FrameDetector::Candidate& c : detector.candidates()) {
      if (c.score < kFurtherInstance || (next != nullptr && c.score <= next->score)) continue;
      bool apart = true;
      for (std::size_t k = 0; k < count; ++k) {
        const Vector3 gap = c.pose * s.model.centre() - seen[k].pose * s.model.centre();
        apart = apart && gap.dot(gap) > 0.25 * s.model.radius() * s.model.radius();
      }
      if (apart) next = &c;
    }
    if (next == nullptr) break;
    seen[count++] = {next->pose, next->score};
  }
  return count;
}

double draw_cloud(RegistrationState& s, std::span<const Point3f> scene, DepthFrame& frame, Intrinsics& camera,
                  RigidTransform& scene_from_camera) noexcept {
  // The camera looks at the middle of the cloud.
  const Vector3 eye = s.eye;
  Vector3 middle = Vector3::Zero();
  std::size_t count = 0;
  for (const Point3f& p : scene) {
    const Vector3 q(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    const Vector3 d = q - eye;
    const double length = std::sqrt(d.dot(d));
    if (!(length > 1e-6 && length < 1e6)) continue;  // not for NaN either
    middle += d / length;
    ++count;
  }
  const double length = std::sqrt(middle.dot(middle));
  if (count < 100 || length < 0.5 * static_cast<double>(count)) return 0;
  const Vector3 z = middle / length;
  const Vector3 up = std::fabs(z.y()) < 0.9 ? Vector3(0, 1, 0) : Vector3(1, 0, 0);
  Vector3 x(up.y() * z.z() - up.z() * z.y(), up.z() * z.x() - up.x() * z.z(),
            up.x() * z.y() - up.y() * z.x());
  x /= std::sqrt(x.dot(x));
  const Vector3 y(z.y() * x.z() - z.z() * x.y(), z.z() * x.x() - z.x() * x.z(),
                  z.x() * x.y() - z.y() * x.x());
  for (int i = 0; i < 3; ++i) {
    scene_from_camera.rotation(i, 0) = x(i);
    scene_from_camera.rotation(i, 1) = y(i);
    scene_from_camera.rotation(i, 2) = z(i);
  }
  scene_from_camera.translation = eye;
  const RigidTransform back = scene_from_camera.inverse();
  double wide = 0, high = 0;
  for (const Point3f& p : scene) {
    const Vector3 q =
        back * Vector3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    if (!(q.z() > 0.05 && q.z() < limits::kMaxDepth)) continue;
    wide = std::max(wide, std::fabs(q.x() / q.z()));
    high = std::max(high, std::fabs(q.y() / q.z()));
  }
  if (!(wide > 1e-3 && wide < 3 && high > 1e-3 && high < 3)) return 0;
  const double pixels = std::min<double>(0.5 * static_cast<double>(count), 1920.0 * 1200.0);
  const double focal = std::sqrt(pixels / (4 * wide * high));
  camera.width =
      std::clamp(static_cast<int>(2 * wide * focal) + 1, limits::kMinFrameWidth, limits::kMaxFrameWidth);
  camera.height =
      std::clamp(static_cast<int>(2 * high * focal) + 1, limits::kMinFrameHeight, limits::kMaxFrameHeight);
  const std::size_t area = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (area > s.picture.size()) return 0;
  camera.fx = std::clamp(0.5 * (camera.width - 1) / wide, 10.0, 10000.0);
  camera.fy = std::clamp(0.5 * (camera.height - 1) / high, 10.0, 10000.0);
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  camera.depth_scale = kDrawnUnitsPerMetre;
  for (std::uint16_t& d : s.picture) d = 0;
  for (const Point3f& p : scene) {
    const Vector3 q =
        back * Vector3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    if (!(q.z() > 0.05 && q.z() < limits::kMaxDepth)) continue;
    const int u = static_cast<int>(std::floor(camera.fx * q.x() / q.z() + camera.cx + 0.5));
    const int v = static_cast<int>(std::floor(camera.fy * q.y() / q.z() + camera.cy + 0.5));
    if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) continue;
    std::uint16_t& d = s.picture[row_major(v, camera.width, u)];
    const auto reading = static_cast<std::uint16_t>(q.z() * kDrawnUnitsPerMetre + 0.5);
    if (d == 0 || reading < d) d = reading;
  }
  frame = DepthFrame();
  frame.depth = s.picture.data();
  frame.width = frame.stride = camera.width;
  frame.height = camera.height;
  // In sight: as near as the nearest of its pixel, but for the slope of a surface across the pixel and noise.
  std::size_t drawn = 0, seen = 0;
  for (const Point3f& p : scene) {
    const Vector3 q =
        back * Vector3(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    if (!(q.z() > 0.05 && q.z() < limits::kMaxDepth)) continue;
    const int u = static_cast<int>(std::floor(camera.fx * q.x() / q.z() + camera.cx + 0.5));
    const int v = static_cast<int>(std::floor(camera.fy * q.y() / q.z() + camera.cy + 0.5));
    if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) continue;
    const double nearest = s.picture[row_major(v, camera.width, u)] / kDrawnUnitsPerMetre;
    ++drawn;
    seen += q.z() - nearest < 0.02 * q.z() ? 1U : 0U;
  }
  return drawn > 0 ? static_cast<double>(seen) / static_cast<double>(drawn) : 0;
}

}  // namespace pliant

#include "core/registration/depth_search.hpp"
#include "core/memory/row_major.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/frame_detector.hpp"

namespace pliant {

namespace {

// What an instance explains: readings this near to its surface, of the model's radius, and 3 σ.
constexpr double kExplained = 0.06;
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
  settings.thorough = true;
  settings.matches = 3;
  settings.model_keypoints = 2048;
  surface.lay_out(workspace, camera);
  detector.lay_out(workspace, s.model, camera, settings);
}

/// The paper's stage that a step of the detector belongs to.
RegistrationStage stage_of(FrameDetector::Phase phase) noexcept {
  switch (phase) {
    case FrameDetector::Phase::normals:
      return RegistrationStage::normals;
    case FrameDetector::Phase::sample:
      return RegistrationStage::keypoints;
    case FrameDetector::Phase::describe:
      return RegistrationStage::descriptors;
    case FrameDetector::Phase::match:
      return RegistrationStage::matching;
    default:
      return RegistrationStage::grouping;
  }
}

bool in_range(const Vector3& p) noexcept {
  return p.z() > 0.05 && p.z() < limits::kMaxDepth;
}

/// The picture without the readings that the model at `pose` explains; kept in s.picture.
DepthFrame without_instance(RegistrationState& s, const DepthFrame& frame, const Intrinsics& camera,
                            const SensorDescription& sensor, const RigidTransform& pose) noexcept {
  DepthFrame rest = frame;
  rest.depth = s.picture.data();
  rest.stride = frame.width;
  if (frame.depth != rest.depth)
    for (int v = 0; v < frame.height; ++v)
      for (int u = 0; u < frame.width; ++u)
        s.picture[static_cast<std::size_t>(v * rest.stride + u)] = frame.depth[v * frame.stride + u];
  for (std::size_t i = 0; i < s.model.size(); ++i) {
    const Point3f& m = s.model.positions()[i];
    const Normal16& n = s.model.normals()[i];
    const Vector3 p = pose * to_vector(m);
    if (p.z() < sensor.near_limit || p.dot(pose.rotation * Vector3(n.x, n.y, n.z)) > 0) continue;
    // A point stands for the surface up to the next one.
    const double half = s.model.spacing() / p.z();
    const double reach = (kExplained * s.model.radius() + 3 * sensor.sigma(p.z())) * camera.depth_scale;
    const double u = camera.fx * p.x() / p.z() + camera.cx, v = camera.fy * p.y() / p.z() + camera.cy;
    const int u0 = std::max(0, static_cast<int>(u - half * camera.fx)),
              u1 = std::min(frame.width - 1, static_cast<int>(u + half * camera.fx + 1)),
              v0 = std::max(0, static_cast<int>(v - half * camera.fy)),
              v1 = std::min(frame.height - 1, static_cast<int>(v + half * camera.fy + 1));
    for (int y = v0; y <= v1; ++y)
      for (int x = u0; x <= u1; ++x) {
        std::uint16_t& d = s.picture[static_cast<std::size_t>(y * rest.stride + x)];
        if (std::fabs(d - p.z() * camera.depth_scale) < reach) d = 0;
      }
  }
  return rest;
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
                           const SensorDescription& sensor, const RegistrationObserver& observer,
                           std::span<SeenInstance> seen) noexcept {
  Workspace workspace(s.depth_block);
  Surface surface;
  FrameDetector detector;
  lay_out(workspace, s, camera, surface, detector);
  if (workspace.exhausted()) return 0;
  surface.start(camera, sensor, s.settings.kernels);
  detector.start(s.model, camera, sensor, s.settings.kernels);
  const auto tell = [&observer](FrameDetector::Phase phase) {
    if (observer.stage_done != nullptr) observer.stage_done(observer.context, stage_of(phase), false);
  };
  // One after the other, each in what the earlier ones leave of the picture.
  DepthFrame rest = frame;
  s.key_count = 0;
  std::size_t count = 0;
  while (count < seen.size()) {
    surface.build(rest, {0, 0, camera.width, camera.height});
    detector.begin(surface);
    while (detector.state() == DetectState::working) {
      const FrameDetector::Phase phase = detector.phase();
      detector.step(1);
      if (detector.phase() != phase) tell(phase);
    }
    tell(detector.phase());
    s.work += detector.work();
    s.key_count = std::max(s.key_count, detector.keypoints_used());
    if (detector.state() != DetectState::found) break;
    seen[count++] = {detector.best().pose, detector.best().score};
    if (count < seen.size()) rest = without_instance(s, rest, camera, sensor, detector.best().pose);
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
    const Vector3 q = to_vector(p);
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
    const Vector3 q = back * to_vector(p);
    if (!in_range(q)) continue;
    wide = std::max(wide, std::fabs(q.x() / q.z()));
    high = std::max(high, std::fabs(q.y() / q.z()));
  }
  if (!(wide > 1e-3 && wide < kMostSlope && high > 1e-3 && high < kMostSlope)) return 0;
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
  // Where the camera has a point, and its pixel; false when it is not in the picture.
  const auto project = [&](const Point3f& p, Vector3& q, std::size_t& pixel) {
    q = back * to_vector(p);
    if (!in_range(q)) return false;
    const int u = static_cast<int>(std::floor(camera.fx * q.x() / q.z() + camera.cx + 0.5));
    const int v = static_cast<int>(std::floor(camera.fy * q.y() / q.z() + camera.cy + 0.5));
    if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) return false;
    pixel = row_major(v, camera.width, u);
    return true;
  };
  Vector3 q;
  std::size_t pixel = 0;
  for (const Point3f& p : scene) {
    if (!project(p, q, pixel)) continue;
    std::uint16_t& d = s.picture[pixel];
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
    if (!project(p, q, pixel)) continue;
    const double nearest = s.picture[pixel] / kDrawnUnitsPerMetre;
    ++drawn;
    seen += q.z() - nearest < 0.02 * q.z() ? 1U : 0U;
  }
  return drawn > 0 ? static_cast<double>(seen) / static_cast<double>(drawn) : 0;
}

}  // namespace pliant

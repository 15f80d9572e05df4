#include "firmware-app/commands/expected_detection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "drivers/model_files/outside_view.hpp"
#include "drivers/simulated/disparity_image.hpp"
#include "drivers/simulated/structure_sensor.hpp"
#include "firmware-app/commands/one_shot_detector.hpp"

namespace pliant {

namespace {

constexpr double kShowsOutside = 0.8;  // of a view's pixels
constexpr double kFills = 0.45;        // of the picture's height, by the model's diameter
constexpr double kNearest = 0.6;       // metres; nearer than a sensor is usually held
constexpr double kFarthest = 1.5;

/// Every model point as a hexagon that closes the gaps to its neighbours.
struct Discs {
  std::vector<Vector3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

OrientedCloud cloud_of(const ModelView& model) {
  OrientedCloud cloud;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Point3f& p = model.positions()[i];
    const Normal16& n = model.normals()[i];
    cloud.points.push_back(to_vector(p));
    cloud.normals.emplace_back(Vector3(n.x, n.y, n.z) / 16384.0);
  }
  return cloud;
}

Discs discs_of(const OrientedCloud& cloud, double radius) {
  constexpr std::array<std::array<double, 2>, 6> kCorners = {
      {{1, 0}, {0.5, 0.8660254}, {-0.5, 0.8660254}, {-1, 0}, {-0.5, -0.8660254}, {0.5, -0.8660254}}};
  Discs discs;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vector3& n = cloud.normals[i];
    const Vector3 helper = std::fabs(n.x()) < 0.6 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
    const Vector3 a = cross(n, helper).normalized(), b = cross(n, a);
    const auto first = static_cast<std::uint32_t>(discs.vertices.size());
    for (const auto& [x, y] : kCorners) discs.vertices.push_back(cloud.points[i] + radius * (x * a + y * b));
    for (std::uint32_t k = 1; k < 5; ++k) discs.triangles.push_back({first, first + k, first + k + 1});
  }
  return discs;
}

/// The camera looks along -towards at the model's middle, `distance` away.
RigidTransform looking_from(const Vector3& towards, const Vector3& middle, double distance) {
  const Vector3 helper = std::fabs(towards.z()) < 0.9 ? Vector3(0, 0, 1) : Vector3(0, 1, 0);
  const Vector3 right = cross(helper, towards).normalized();
  RigidTransform pose;
  pose.rotation.row(0) = right;
  pose.rotation.row(2) = -towards;
  pose.rotation.row(1) = cross(-towards, right);
  pose.translation = Vector3(0, 0, distance) - pose.rotation * middle;
  return pose;
}

bool everywhere(const Vector3& /*point*/, const void* /*context*/) {
  return true;
}

/// Share of the outside in what shows from `towards`, by the points' normals alone: of a front without a back
/// the inside faces the other half.
double facing_share(const OrientedCloud& cloud, const Vector3& towards) {
  double front = 0, all = 0;
  for (const Vector3& n : cloud.normals) {
    const double cosine = n.dot(towards);
    front += std::max(cosine, 0.0);
    all += std::fabs(cosine);
  }
  return all > 0 ? front / all : 0;
}

}  // namespace

ExpectedDetection expect_detection(const ModelView& model) {
  const Intrinsics camera{640, 480, 570, 570, 320, 240, 1000};
  const SensorDescription sensor;
  const OrientedCloud cloud = cloud_of(model);
  ExpectedDetection expected;
  expected.coverage = outside_share(cloud, model.spacing());
  const double diameter = 2 * model.radius();
  expected.distance = std::clamp(diameter * camera.fy / (kFills * camera.height), kNearest, kFarthest);
  const Discs discs = discs_of(cloud, 1.1 * model.spacing());

  const Result<std::unique_ptr<OneShotDetector>> detector = OneShotDetector::create(model, camera, sensor);
  if (!detector) return expected;
  simulated::DisparityImage scene(camera);
  simulated::StructureSensor noise(camera, sensor, 1);
  std::vector<std::uint16_t> depth(scene.pixels().size());
  std::vector<Vector3> placed(discs.vertices.size());
  const std::vector<Vector3> directions = view_directions();
  // Of a closed shape as much faces any direction as faces away.
  const bool closed = expected.coverage > kShowsOutside;
  for (std::size_t k = 0; k < directions.size(); k += 2) {
    if (!closed && facing_share(cloud, directions[k]) < kShowsOutside) continue;
    const RigidTransform pose = looking_from(directions[k], model.centre(), expected.distance);
    for (std::size_t i = 0; i < placed.size(); ++i) placed[i] = pose * discs.vertices[i];
    scene.clear();
    scene.draw_plane(Vector3(0, 0, -1), -(expected.distance + diameter), &everywhere, nullptr);
    scene.draw(placed, discs.triangles, {});
    noise.measure(scene, static_cast<std::int64_t>(k), depth);
    ++expected.views;
    if (!(*detector)->look({depth.data(), camera.width, camera.height, camera.width, 0, 0})) continue;
    const RigidTransform& found = (*detector)->best().pose;
    constexpr double kCos10 = 0.98481;
    const double apart = (found * model.centre() - pose * model.centre()).norm();
    if (cos_angle(found.rotation.transpose() * pose.rotation) > kCos10 && apart < 0.1 * diameter)
      ++expected.found;
  }
  return expected;
}

}  // namespace pliant

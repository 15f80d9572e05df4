#include "drivers/simulated/scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "drivers/simulated/implicit.hpp"
#include "drivers/simulated/motion.hpp"
#include "drivers/simulated/surface_nets.hpp"

namespace pliant::simulated {

namespace {

constexpr double kTableLeft = -0.70, kTableRight = 0.80, kTableBack = 0.62;  ///< metres
constexpr double kPanel = 0.70;                                              ///< metres behind the origin
constexpr double kPanelLeft = -0.45, kPanelTop = 0.60;                       ///< metres

double bottle(const Vector3& p) {
  const double body = capsule(p, {-0.34, 0.24, 0.02}, {-0.34, 0.24, 0.13}, 0.038);
  return smooth_union(body, capsule(p, {-0.34, 0.24, 0.13}, {-0.34, 0.24, 0.22}, 0.014), 0.02);
}
double carton(const Vector3& p) {
  // Turned by 30 degrees: (0.5, 0.866).
  const Vector3 q(0.866 * (p.x() - 0.30) + 0.5 * (p.y() - 0.40),
                  -0.5 * (p.x() - 0.30) + 0.866 * (p.y() - 0.40), p.z());
  return rounded_box(q, {0, 0, 0.06}, {0.09, 0.05, 0.07}, 0.006);
}
double ball(const Vector3& p) {
  return sphere(p, {-0.42, -0.06, 0.045}, 0.048);
}
double mug(const Vector3& p) {
  const Vector3 q(p.x() - 0.47, p.y() - 0.20, 0);
  const double side = std::sqrt(q.x() * q.x() + q.y() * q.y()) - 0.040;
  const double body = std::max(side, std::fabs(p.z() - 0.045) - 0.05);
  return smooth_union(body, capsule(p, {0.43, 0.18, 0.03}, {0.405, 0.17, 0.05}, 0.008), 0.005);
}

bool on_table(const Vector3& p, const void* context) {
  const Vector3 t = static_cast<const RigidTransform*>(context)->inverse() * p;
  return t.x() > kTableLeft && t.x() < kTableRight && t.y() < kTableBack;
}
bool on_panel(const Vector3& p, const void* context) {
  const Vector3 t = static_cast<const RigidTransform*>(context)->inverse() * p;
  return t.x() > kPanelLeft && t.z() < kPanelTop && t.z() > -0.75;
}

}  // namespace

RigidTransform camera_from_table(const View& view) {
  const double s = sine(kDegree * view.pitch);
  const double c = cosine(kDegree * view.pitch);
  RigidTransform pose;
  pose.rotation << 1, 0, 0,  //
      0, -s, -c,             //
      0, c, -s;
  if (view.azimuth != 0) pose.rotation = pose.rotation * rotation_about(Vector3::UnitZ(), -view.azimuth);
  pose.translation = Vector3(0, 0, view.distance) - pose.rotation * Vector3(0, 0, view.height);
  return pose;
}

Surroundings::Surroundings() {
  std::size_t most = 0;
  const auto add = [&](Solid solid, const Vector3& low, const Vector3& high) {
    Geometry mesh = mesh_of(solid, low, high, 0.008);
    Thing thing;
    for (const Point3f& p : mesh.vertices) thing.vertices.push_back(to_vector(p));
    thing.triangles = std::move(mesh.triangles);
    most = std::max(most, thing.vertices.size());
    things_.push_back(std::move(thing));
  };
  add(&bottle, {-0.40, 0.18, -0.04}, {-0.28, 0.30, 0.26});
  add(&carton, {0.16, 0.28, -0.03}, {0.44, 0.52, 0.15});
  add(&ball, {-0.49, -0.13, -0.02}, {-0.35, 0.01, 0.11});
  add(&mug, {0.38, 0.14, -0.03}, {0.53, 0.26, 0.12});
  placed_.reserve(most);
}

void Surroundings::draw(const RigidTransform& pose, DisparityImage& image) {
  const auto draw_plane = [&](const Vector3& normal, double offset, auto* covers) {
    const Vector3 in_camera = pose.rotation * normal;
    image.draw_plane(in_camera, offset + in_camera.dot(pose.translation), covers, &pose);
  };
  draw_plane(Vector3::UnitZ(), 0, &on_table);
  draw_plane(Vector3::UnitY(), kPanel, &on_panel);
  for (const Thing& thing : things_) {
    placed_.clear();
    for (const Vector3& p : thing.vertices) placed_.push_back(pose * p);
    image.draw(placed_, thing.triangles, {});
  }
}

}  // namespace pliant::simulated

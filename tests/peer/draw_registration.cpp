// Pictures like the paper's Figures 8 to 10: draw_registration CASE_DIR SCENE OUT.png MODEL_KEYPOINTS
// SCENE_KEYPOINTS. Registers a case and draws the scene, grey, and beside it the scene with the model's
// points where it shows them, regions and deformed points in their colours, from the side on which the points
// are spread widest.
#include <Eigen/Geometry>
#include <cstdio>
#include <cstdlib>

#include "core/detect/symmetric_eigen.hpp"
#include "core/memory/row_major.hpp"
#include "drivers/images/png.hpp"
#include "firmware-app/pictures/scene_picture.hpp"
#include "tests/accuracy/registration_runs.hpp"

namespace pliant {
namespace {

constexpr int kSide = 480;        // pixels, of each of the two pictures
constexpr int kKeyWidth = 440;    // pixels before them
constexpr double kDotRadius = 2;  // pixels, of a scene point
constexpr double kUnits = 10000;  // of the drawn depth, a metre

/// Draws points as they are seen by `camera` into a depth picture of its size, columns [first, last) alone.
void draw_points(std::span<const Point3f> points, const RigidTransform& pose, const Intrinsics& camera,
                 int first, int last, std::vector<std::uint16_t>& depth) {
  for (const Point3f& point : points) {
    const Vector3 p = pose * to_vector(point);
    if (!(p.z() > 0 && p.z() * kUnits < 65535)) continue;
    const double u = camera.fx * p.x() / p.z() + camera.cx, v = camera.fy * p.y() / p.z() + camera.cy;
    const auto reading = static_cast<std::uint16_t>(p.z() * kUnits);
    for (int y = std::max(0, static_cast<int>(v - kDotRadius));
         y <= std::min(camera.height - 1, static_cast<int>(v + kDotRadius)); ++y)
      for (int x = std::max(first, static_cast<int>(u - kDotRadius));
           x <= std::min(last - 1, static_cast<int>(u + kDotRadius)); ++x) {
        std::uint16_t& held = depth[row_major(y, camera.width, x)];
        if (held == 0 || reading < held) held = reading;
      }
  }
}

/// camera <- scene: looks along the direction in which the points are spread least, from the side of `front`,
/// `up` at the top.
RigidTransform looking_at(std::span<const Point3f> points, const Vector3& front, const Vector3& up) {
  Vector3 mean = Vector3::Zero();
  for (const Point3f& p : points) mean += to_vector(p);
  mean /= static_cast<double>(points.size());
  Matrix3 spread = Matrix3::Zero();
  for (const Point3f& p : points) spread += (to_vector(p) - mean) * (to_vector(p) - mean).transpose();
  const SymmetricEigen eigen = symmetric_eigen(spread);
  Vector3 z = eigen.vectors.col(0);
  if (z.dot(front) > 0) z = -z;
  Vector3 y = eigen.vectors.col(2);  // the longest way runs down the picture
  if (y.dot(up) > 0) y = -y;
  const Vector3 x = y.cross(z);
  RigidTransform camera;
  camera.rotation.row(0) = x.transpose();
  camera.rotation.row(1) = y.transpose();
  camera.rotation.row(2) = z.transpose();
  const double size = std::sqrt(eigen.values(2) / static_cast<double>(points.size()));
  camera.translation = Vector3(0, 0, 8 * size) - camera.rotation * mean;
  return camera;
}

/// Leaves the places of the model's points black, so that their colours show.
void clear_around(std::span<const Point3f> points, const Intrinsics& camera, int first,
                  std::vector<std::uint16_t>& depth) {
  constexpr int kAround = 5;  // pixels: between the points too
  for (const Point3f& point : points) {
    if (!(point.z > 0)) continue;
    const Vector3 p = to_vector(point);
    const int u = static_cast<int>(camera.fx * p.x() / p.z() + camera.cx),
              v = static_cast<int>(camera.fy * p.y() / p.z() + camera.cy);
    for (int y = std::max(0, v - kAround); y <= std::min(camera.height - 1, v + kAround); ++y)
      for (int x = std::max(first, u - kAround); x <= std::min(camera.width - 1, u + kAround); ++x)
        depth[row_major(y, camera.width, x)] = 0;
  }
}

int draw(char** argv) {
  const std::filesystem::path folder(argv[1]);
  const BuiltFromFile model(folder / "model.ply");
  const Result<Geometry> scene = read_geometry(folder / argv[2]);
  if (!model.good || !scene) {
    std::fputs("draw_registration: the case cannot be read\n", stderr);
    return 2;
  }
  RegistrationSettings settings;
  settings.model_keypoints = static_cast<std::uint32_t>(std::strtoul(argv[4], nullptr, 10));
  settings.scene_keypoints = static_cast<std::uint32_t>(std::strtoul(argv[5], nullptr, 10));
  ReadyRegistration run(model.view, scene->vertices.size(), settings);
  if (run.fault != nullptr) {
    std::fprintf(stderr, "draw_registration: %s\n", run.fault);
    return 2;
  }
  const RegistrationResult& result = run.registration.register_cloud(scene->vertices);
  if (result.instances.empty()) {
    std::fputs("draw_registration: not found\n", stderr);
    return 1;
  }
  const InstanceResult& found = result.instances[0];
  const RigidTransform& base = found.regions[0].transform;
  // Deformed points should lie on the side that is seen.
  Vector3 front = Vector3::Zero();
  std::vector<float> displacement(model.view.size(), 0);
  for (std::size_t i = 0; i < model.view.size(); ++i) {
    if (found.labels[i] != kDeformed) continue;
    const Normal16& n = model.view.normals()[i];
    front += base.rotation * Vector3(n.x, n.y, n.z);
    displacement[i] = static_cast<float>(
        (to_vector(found.positions[i]) - base * to_vector(model.view.positions()[i])).norm());
  }
  const RigidTransform camera =
      looking_at(found.positions, front, base.rotation.col(1));  // meshes stand along y
  std::vector<Point3f> points;
  std::vector<std::int8_t> labels(found.labels.begin(), found.labels.end());
  for (std::size_t i = 0; i < model.view.size(); ++i) {
    points.push_back(to_point(camera * to_vector(found.positions[i])));
    // What faces away would shine through.
    const Normal16& n = model.view.normals()[i];
    const std::size_t region = found.labels[i] > 0 ? static_cast<std::size_t>(found.labels[i]) : 0;
    const Vector3 normal =
        camera.rotation * found.regions[region].transform.rotation * Vector3(n.x, n.y, n.z);
    if (normal.dot(to_vector(points.back())) > 0) points.back().z = -1;
  }
  SceneView view;
  view.positions = points;
  view.labels = labels;
  view.displacement = displacement;
  view.spacing = model.view.spacing();
  Intrinsics seen = camera_that_shows(points, kSide, kSide);
  seen.width = kKeyWidth + 2 * kSide;
  std::vector<std::uint16_t> depth(table_size(seen.width, seen.height), 0);
  seen.cx += kKeyWidth;
  draw_points(scene->vertices, camera, seen, kKeyWidth, kKeyWidth + kSide, depth);
  seen.cx += kSide;
  draw_points(scene->vertices, camera, seen, kKeyWidth + kSide, seen.width, depth);
  clear_around(points, seen, kKeyWidth + kSide, depth);
  view.camera = seen;
  view.depth = depth;
  view.title = folder.filename().string();
  const Canvas canvas = draw_scene(view);
  if (const Outcome written = write_png_rgb8(argv[3], canvas.width(), canvas.height(), canvas.rgb());
      !written) {
    std::fprintf(stderr, "draw_registration: %s\n", written.error().message.c_str());
    return 3;
  }
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  if (argc != 6) {
    std::fputs("usage: draw_registration CASE_DIR SCENE OUT.png MODEL_KEYPOINTS SCENE_KEYPOINTS\n", stderr);
    return 2;
  }
  return pliant::draw(argv);
}

// Pliant and PCL on the same case, alternating in one process, one thread each:
// compare_with_pcl CASE_DIR SCENE.ply MODEL_KEYPOINTS SCENE_KEYPOINTS [RUNS] [PCL_RESULT.ply]
// Prints a line of a table. With a name for PCL's result, its labels after ICP by the paper's radius test are
// written there as `pliant register -o` would.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/detect/point_grid.hpp"
#include "drivers/geometry_files/points_ply.hpp"
#include "tests/accuracy/registration_runs.hpp"
#include "tests/peer/pcl_pipeline.hpp"

namespace pliant {
namespace {

peer::Points plain(std::span<const Point3f> points) {
  peer::Points out;
  for (const Point3f& p : points) out.push_back({p.x, p.y, p.z});
  return out;
}

/// Nearest points of a cloud, for what is not timed.
struct Index {
  explicit Index(std::span<const Point3f> points, double cell) : block(points.size() * 64 + 65536) {
    Workspace workspace(block.bytes);
    grid.lay_out(workspace, points.size());
    static_cast<void>(grid.build(points, cell));
  }
  AlignedBlock block;
  PointGrid grid;
};

Point3f carried(const RigidTransform& pose, const Point3f& p) {
  return to_point(pose * to_vector(p));
}

/// Outward directions of the scene's points: the normal of the model's nearest point under the true pose,
/// zero far from it.
peer::Points true_signs(const ModelView& model, const RigidTransform& pose, std::span<const Point3f> scene) {
  const Index index(model.positions(), 3 * model.spacing());
  const RigidTransform back = pose.inverse();
  peer::Points signs;
  for (const Point3f& p : scene) {
    float square = 0;
    const std::uint32_t i =
        index.grid.nearest(carried(back, p), static_cast<float>(10 * model.spacing()), square);
    if (i == PointGrid::kNone) {
      signs.push_back({0, 0, 0});
      continue;
    }
    const Normal16& n = model.normals()[i];
    const Vector3 d = pose.rotation * Vector3(n.x, n.y, n.z);
    signs.push_back(to_point(d));
  }
  return signs;
}

peer::Points model_signs(const ModelView& model) {
  peer::Points signs;
  for (const Normal16& n : model.normals())
    signs.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
  return signs;
}

RigidTransform pose_of(const std::array<double, 16>& rows) {
  RigidTransform pose;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) pose.rotation(r, c) = rows[static_cast<std::size_t>(4 * r + c)];
    pose.translation(r) = rows[static_cast<std::size_t>(4 * r + 3)];
  }
  return pose;
}

std::string error_of(const ModelView& model, const RigidTransform& pose, const RigidTransform& truth) {
  char text[64];
  std::snprintf(text, sizeof text, "%.2f° %.2f mm", degrees_between(pose.rotation, truth.rotation),
                1e3 * (pose * model.centre() - truth * model.centre()).norm());
  return text;
}

/// The paper's test: a model point with a scene point within a spacing and a half is rigid, the others are
/// deformed. (Within one spacing PCL is wrong three times as often.)
void write_labels(const char* path, const ModelView& model, const RigidTransform& pose,
                  std::span<const Point3f> scene) {
  const Index index(scene, 2 * model.spacing());
  std::vector<Point3f> positions;
  std::vector<std::int8_t> labels;
  std::vector<std::int32_t> matches;
  std::vector<float> residuals;
  for (const Point3f& p : model.positions()) {
    positions.push_back(carried(pose, p));
    float square = 0;
    const std::uint32_t j =
        index.grid.nearest(positions.back(), static_cast<float>(1.5 * model.spacing()), square);
    labels.push_back(j == PointGrid::kNone ? kDeformed : 0);
    matches.push_back(j == PointGrid::kNone ? -1 : static_cast<std::int32_t>(j));
    residuals.push_back(j == PointGrid::kNone ? 0 : std::sqrt(square));
  }
  PointsPlyWriter writer(model.positions());
  if (const Outcome written = writer.write(path, positions, labels, matches, residuals); !written)
    std::fprintf(stderr, "compare_with_pcl: %s\n", written.error().message.c_str());
}

int compare(int argc, char** argv) {
  const std::filesystem::path folder(argv[1]);
  const BuiltFromFile model(folder / "model.ply");
  const Result<Geometry> scene = read_geometry(folder / argv[2]);
  const std::vector<RigidTransform> truth = read_true_poses(folder / "gt_pose.txt");
  if (!model.good || !scene || truth.empty()) {
    std::fputs("compare_with_pcl: the case cannot be read\n", stderr);
    return 2;
  }
  RegistrationSettings settings;
  settings.model_keypoints = static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10));
  settings.scene_keypoints = static_cast<std::uint32_t>(std::strtoul(argv[4], nullptr, 10));
  const int runs = argc > 5 ? std::max(1, std::atoi(argv[5])) : 5;
  ReadyRegistration ours(model.view, scene->vertices.size(), settings);
  if (ours.fault != nullptr) {
    std::fprintf(stderr, "compare_with_pcl: %s\n", ours.fault);
    return 2;
  }
  StageClock clock;
  ours.registration.observe(clock.observer());

  peer::PclSettings theirs;
  theirs.support = 7 * model.view.spacing();
  theirs.consistency = 2.4 * model.view.spacing();
  theirs.model_keypoints = settings.model_keypoints;
  theirs.scene_keypoints = settings.scene_keypoints;
  const peer::PclPipeline pcl(plain(model.view.positions()), model_signs(model.view), theirs);
  const peer::Points points = plain(scene->vertices),
                     signs = true_signs(model.view, truth[0], scene->vertices);

  std::vector<double> our_times, their_times, stages[kRegistrationStageCount], parts[5];
  RegistrationResult result;
  peer::PclResult peer_result;
  for (int k = 0; k < runs; ++k) {
    peer_result = pcl.run(points, signs, k == 0);
    static std::array<double, 16> refined;
    if (k == 0) refined = peer_result.refined;
    peer_result.refined = refined;
    their_times.push_back(peer_result.times.total());
    const peer::PclTimes& t = peer_result.times;
    const double each[5] = {t.normals, t.keypoints, t.descriptors, t.matching, t.grouping};
    for (int s = 0; s < 5; ++s) parts[s].push_back(each[s]);
    clock.begin();
    result = ours.registration.register_cloud(scene->vertices);
    our_times.push_back(clock.total());
    for (int s = 0; s < kRegistrationStageCount; ++s) stages[s].push_back(clock.ms[s]);
  }
  const double mine = median_of(our_times), other = median_of(their_times);
  const bool found = result.outcome == RegistrationOutcome::found && !result.instances.empty();
  std::printf("| %s | %u × %u | %zu × %zu |", folder.filename().c_str(), result.model_keypoints,
              result.scene_keypoints, peer_result.model_keypoints, peer_result.scene_keypoints);
  for (const std::vector<double>& s : stages) std::printf(" %.1f", median_of(s));
  std::printf(" = **%.1f** |", mine);
  for (const std::vector<double>& s : parts) std::printf(" %.1f", median_of(s));
  std::printf(" = **%.0f** | **%.1f×** | %s | %s (ICP: %s) |\n", other, other / mine,
              found ? error_of(model.view, result.instances[0].regions[0].transform, truth[0]).c_str() : "–",
              peer_result.found ? error_of(model.view, pose_of(peer_result.grouped), truth[0]).c_str() : "–",
              peer_result.found ? error_of(model.view, pose_of(peer_result.refined), truth[0]).c_str() : "–");
  if (argc > 6 && peer_result.found)
    write_labels(argv[6], model.view, pose_of(peer_result.refined), scene->vertices);
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs(
        "usage: compare_with_pcl CASE_DIR SCENE MODEL_KEYPOINTS SCENE_KEYPOINTS [RUNS] [PCL_RESULT.ply]\n",
        stderr);
    return 2;
  }
  return pliant::compare(argc, argv);
}

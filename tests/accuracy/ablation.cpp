// What each part of the method is worth: ablation SHARED_DATA TARGET.obj VIEWS CLUTTER.obj...
// Registers the shared cases and random single views (as clouds seen from the origin) with one part switched
// off at a time and prints a table.
#include <cstdio>
#include <cstdlib>

#include "core/memory/row_major.hpp"
#include "tests/accuracy/registration_runs.hpp"
#include "tests/accuracy/view_maker.hpp"

namespace pliant {
namespace {

struct Variant {
  const char* name;
  bool RegistrationSettings::*off;
};

/// Parts whose pose is within 1.5° and 2 mm of the truth, or the base's errors where there is one part.
void print_case(const std::filesystem::path& folder, const char* scene_name,
                const RegistrationSettings& settings) {
  const BuiltFromFile model(folder / "model.ply");
  const Result<Geometry> scene = read_geometry(folder / scene_name);
  const std::vector<RigidTransform> truth = read_true_poses(folder / "gt_pose.txt");
  if (!model.good || !scene || truth.empty()) {
    std::printf(" no data |");
    return;
  }
  ReadyRegistration run(model.view, scene->vertices.size(), settings);
  const double start = thread_ms();
  const RegistrationResult& result = run.registration.register_cloud(scene->vertices);
  const double took = thread_ms() - start;
  if (result.outcome != RegistrationOutcome::found) {
    std::printf(" not found, %.0f ms |", took);
    return;
  }
  const auto off = [&](const RigidTransform& a, const RigidTransform& b) {
    return (a * model.view.centre() - b * model.view.centre()).norm();
  };
  const auto& regions = result.instances[0].regions;
  if (truth.size() == 1) {
    std::printf(" %.2f° %.2f mm, %.0f ms |",
                degrees_between(regions[0].transform.rotation, truth[0].rotation),
                1e3 * off(regions[0].transform, truth[0]), took);
    return;
  }
  std::size_t right = 0;
  for (const RigidTransform& pose : truth) {
    bool has = false;
    for (const RegionResult& region : regions)
      has = has || (degrees_between(region.transform.rotation, pose.rotation) < 1.5 &&
                    off(region.transform, pose) < 0.002);
    right += has ? 1U : 0U;
  }
  std::printf(" %zu of %zu parts, %.0f ms |", right, truth.size(), took);
}

std::vector<Point3f> cloud_of(const std::vector<std::uint16_t>& picture, const Intrinsics& camera) {
  std::vector<Point3f> points;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const double z = picture[row_major(v, camera.width, u)] / camera.depth_scale;
      if (z > 0)
        points.push_back({static_cast<float>((u - camera.cx) / camera.fx * z),
                          static_cast<float>((v - camera.cy) / camera.fy * z), static_cast<float>(z)});
    }
  return points;
}

void print_views(const ScaledMesh& target, const std::vector<ScaledMesh>& others, int views,
                 const RegistrationSettings& settings) {
  const BuiltFromFile model(geometry_of(target));
  const Intrinsics camera = structure_camera();
  ReadyRegistration run(model.view, table_size(camera.width, camera.height), settings);
  ViewMaker maker(target, others);
  int right = 0, wrong = 0, claims = 0;
  std::uint64_t seed = 1;
  for (int made = 0; made < views; ++seed) {
    View view;
    if (!maker.make(seed, view)) continue;
    ++made;
    const RegistrationResult& result = run.registration.register_cloud(cloud_of(view.with, camera));
    if (result.outcome == RegistrationOutcome::found) {
      const RigidTransform& pose = result.instances[0].regions[0].transform;
      const bool good = degrees_between(pose.rotation, view.pose.rotation) <= 5 &&
                        (pose * model.view.centre() - view.pose * model.view.centre()).norm() <= 0.02 * kSize;
      (good ? right : wrong) += 1;
    }
    claims +=
        run.registration.register_cloud(cloud_of(view.without, camera)).outcome == RegistrationOutcome::found;
  }
  std::printf(" %d of %d, %d wrong, %d claims |\n", right, views, wrong, claims);
}

int compare(int argc, char** argv) {
  const std::filesystem::path cases = std::filesystem::path(argv[1]) / "cases";
  const Result<Geometry> file = read_geometry(argv[2]);
  if (!file) {
    std::fprintf(stderr, "ablation: %s\n", file.error().message.c_str());
    return 2;
  }
  const ScaledMesh target = scaled(*file, kSize);
  std::vector<ScaledMesh> others = {ball(0.05), ball(0.09)};
  for (int k = 4; k < argc; ++k)
    if (const Result<Geometry> other = read_geometry(argv[k]); other) others.push_back(scaled(*other, 0.25));
  const Variant variants[] = {{"everything", nullptr},
                              {"no consistent normals", &RegistrationSettings::consistent_normals},
                              {"no local-frame hypotheses", &RegistrationSettings::frame_hypotheses},
                              {"no free space", &RegistrationSettings::free_space},
                              {"no grouping", &RegistrationSettings::grouping},
                              {"no refinement", &RegistrationSettings::refinement}};
  std::printf(
      "| | a_misaligned | b2, 50 %% noise | c_humanoid | d1_pillow | d2_pillow_clutter | single views |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const Variant& variant : variants) {
    RegistrationSettings settings;
    if (variant.off != nullptr) settings.*variant.off = false;
    std::printf("| %s |", variant.name);
    print_case(cases / "a_misaligned", "scene.ply", settings);
    print_case(cases / "b2_local_clutter_resampled", "scene_n050_s0.ply", settings);
    print_case(cases / "c_humanoid", "scene.ply", settings);
    print_case(cases / "d1_pillow", "scene.ply", settings);
    print_case(cases / "d2_pillow_clutter", "scene.ply", settings);
    std::fflush(stdout);
    print_views(target, others, std::max(1, std::atoi(argv[3])), settings);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("usage: ablation SHARED_DATA TARGET VIEWS CLUTTER...\n", stderr);
    return 2;
  }
  return pliant::compare(argc, argv);
}

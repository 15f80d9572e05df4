// How often a mesh is found in single simulated depth pictures: random_views TARGET.obj VIEWS FIRST_SEED
// CLUTTER.obj... Every view is a Structure Sensor's picture of the target (30 cm across) at 0.5 to 1.2 m,
// turned at random, among clutter that makes up at least half of the readings: the other meshes, balls, a
// table, a wall. The same views without the target count false claims. The same seeds give the same views.
#include <cstdio>
#include <cstdlib>

#include "core/memory/row_major.hpp"
#include "tests/accuracy/registration_runs.hpp"
#include "tests/accuracy/view_maker.hpp"
#include "tests/frame_of.hpp"

namespace pliant {
namespace {

constexpr double kRightDegrees = 5, kRightShare = 0.02;

int look(int argc, char** argv) {
  const Result<Geometry> file = read_geometry(argv[1]);
  if (!file) {
    std::fprintf(stderr, "random_views: %s\n", file.error().message.c_str());
    return 2;
  }
  const ScaledMesh target = scaled(*file, kSize);
  const BuiltFromFile model(geometry_of(target));
  std::vector<ScaledMesh> others = {ball(0.05), ball(0.09)};
  for (int k = 4; k < argc; ++k) {
    const Result<Geometry> other = read_geometry(argv[k]);
    if (!other) {
      std::fprintf(stderr, "random_views: %s\n", other.error().message.c_str());
      return 2;
    }
    others.push_back(scaled(*other, 0.2));
    others.push_back(scaled(*other, 0.3));
  }
  if (!model.good) {
    std::fputs("random_views: the target makes no model\n", stderr);
    return 2;
  }
  const int views = std::max(1, std::atoi(argv[2]));
  std::uint64_t seed = std::strtoull(argv[3], nullptr, 10);
  const Intrinsics camera = structure_camera();
  ReadyRegistration run(model.view, table_size(camera.width, camera.height));
  if (run.fault != nullptr) {
    std::fprintf(stderr, "random_views: %s\n", run.fault);
    return 2;
  }
  ViewMaker maker(target, others);
  int right = 0, wrong = 0, missed = 0, claims = 0;
  std::vector<double> times, empty_times, works, empty_works;
  for (int made = 0; made < views; ++seed) {
    View view;
    if (!maker.make(seed, view)) continue;
    ++made;
    double start = thread_ms();
    const RegistrationResult& result =
        run.registration.register_depth(test::frame_of(view.with, camera), camera, SensorDescription());
    times.push_back(thread_ms() - start);
    works.push_back(1e-6 * static_cast<double>(result.work));
    if (result.outcome != RegistrationOutcome::found) {
      ++missed;
      std::printf("seed %llu: missed, %.0f %% of it in sight at %.2f m\n",
                  static_cast<unsigned long long>(seed), 100 * view.seen, view.pose.translation.z());
    } else {
      const RigidTransform& pose = result.instances[0].regions[0].transform;
      const double off = (pose * model.view.centre() - view.pose * model.view.centre()).norm();
      const double turned = degrees_between(pose.rotation, view.pose.rotation);
      const bool good = turned <= kRightDegrees && off <= kRightShare * kSize;
      (good ? right : wrong) += 1;
      if (!good)
        std::printf("seed %llu: %.1f° and %.1f mm off, score %.2f, %.0f %% in sight at %.2f m\n",
                    static_cast<unsigned long long>(seed), turned, 1e3 * off, result.instances[0].score,
                    100 * view.seen, view.pose.translation.z());
    }
    start = thread_ms();
    const RegistrationResult& nothing =
        run.registration.register_depth(test::frame_of(view.without, camera), camera, SensorDescription());
    empty_times.push_back(thread_ms() - start);
    empty_works.push_back(1e-6 * static_cast<double>(nothing.work));
    if (nothing.outcome == RegistrationOutcome::found) {
      ++claims;
      std::printf("seed %llu: claimed without being there, score %.2f\n",
                  static_cast<unsigned long long>(seed), nothing.instances[0].score);
    }
    std::fflush(stdout);
  }
  std::printf("| %s | %d | %.1f %% | %d wrong, %d missed | %d of %d | %.0f, %.0f ms | %.0f, %.0f million |\n",
              std::filesystem::path(argv[1]).stem().c_str(), views, 100.0 * right / views, wrong, missed,
              claims, views, median_of(times), median_of(empty_times), median_of(works),
              median_of(empty_works));
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: random_views TARGET VIEWS FIRST_SEED CLUTTER...\n", stderr);
    return 2;
  }
  return pliant::look(argc, argv);
}

// Registration of the shared cases and real scenes: poses against the truth, absent objects.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/images/png.hpp"
#include "drivers/recording/camera_file.hpp"
#include "tests/accuracy/registration_runs.hpp"

namespace pliant {
namespace {

const std::filesystem::path kData = PLIANT_SHARED_DATA;

struct Case {
  const char* folder;
  const char* scene;
  double most_degrees, most_metres;
  std::size_t regions;
};

/// Names the case where a test is listed.
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.folder << '/' << c.scene;
}

class RegistrationCase : public ::testing::TestWithParam<Case> {};

TEST_P(RegistrationCase, EveryRegionHasATruePartsPose) {
  const Case& c = GetParam();
  const std::filesystem::path folder = kData / "cases" / c.folder;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data at " << folder;
  const BuiltFromFile model(folder / "model.ply");
  ASSERT_TRUE(model.good);
  const Result<Geometry> scene = read_geometry(folder / c.scene);
  ASSERT_TRUE(scene);
  ReadyRegistration run(model.view, scene->vertices.size());
  ASSERT_EQ(run.fault, nullptr);
  const RegistrationResult& result = run.registration.register_cloud(scene->vertices);
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  const std::vector<RigidTransform> truth = read_true_poses(folder / "gt_pose.txt");
  ASSERT_FALSE(truth.empty());
  EXPECT_EQ(result.instances[0].regions.size(), c.regions);
  for (const RegionResult& region : result.instances[0].regions) {
    double best = 1e9, off = 1e9;
    for (const RigidTransform& pose : truth)
      if (degrees_between(pose.rotation, region.transform.rotation) < best) {
        best = degrees_between(pose.rotation, region.transform.rotation);
        off = (pose * model.view.centre() - region.transform * model.view.centre()).norm();
      }
    EXPECT_LT(best, c.most_degrees) << static_cast<int>(region.id);
    EXPECT_LT(off, c.most_metres) << static_cast<int>(region.id);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shared, RegistrationCase,
    ::testing::Values(Case{"a_misaligned", "scene.ply", 0.3, 0.0003, 1},
                      Case{"b2_local_clutter_resampled", "scene_n030_s0.ply", 1, 0.0015, 1},
                      Case{"b2_local_clutter_resampled", "scene_n100_s0.ply", 1, 0.0015, 1},
                      Case{"c_humanoid", "scene.ply", 1.5, 0.003, 3},
                      Case{"d1_pillow", "scene.ply", 1, 0.002, 1},
                      Case{"d2_pillow_clutter", "scene.ply", 1, 0.002, 1}));

TEST(RegistrationCases, AnAbsentObjectIsNotFound) {
  const std::filesystem::path cases = kData / "cases";
  if (!std::filesystem::exists(cases)) GTEST_SKIP() << "no shared data at " << cases;
  const BuiltFromFile figure(cases / "c_humanoid" / "model.ply"), pillow(cases / "d1_pillow" / "model.ply");
  ASSERT_TRUE(figure.good && pillow.good);
  const auto outcome = [&](const BuiltFromFile& model, const char* scene) {
    const Result<Geometry> cloud = read_geometry(cases / scene);
    EXPECT_TRUE(cloud);
    ReadyRegistration run(model.view, cloud->vertices.size());
    EXPECT_EQ(run.fault, nullptr);
    return run.registration.register_cloud(cloud->vertices).outcome;
  };
  EXPECT_EQ(outcome(figure, "d2_pillow_clutter/scene.ply"), RegistrationOutcome::not_found);
  EXPECT_EQ(outcome(figure, "b2_local_clutter_resampled/scene_n010_s0.ply"), RegistrationOutcome::not_found);
  EXPECT_EQ(outcome(pillow, "a_misaligned/scene.ply"), RegistrationOutcome::not_found);
  EXPECT_EQ(outcome(pillow, "b2_local_clutter_resampled/scene_n010_s0.ply"), RegistrationOutcome::not_found);
}

TEST(RegistrationScenes, TheMilkCartonIsTheMiddleObject) {
  const std::filesystem::path folder = kData / "real_milk_clutter";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data at " << folder;
  const Result<Geometry> scene = read_geometry(folder / "milk_cartoon_all_small_clorox.pcd");
  ASSERT_TRUE(scene);
  for (const char* name : {"milk.pcd", "milk_color.pcd"}) {
    const BuiltFromFile model(folder / name);
    ASSERT_TRUE(model.good) << name;
    ReadyRegistration run(model.view, scene->vertices.size());
    ASSERT_EQ(run.fault, nullptr);
    const RegistrationResult& result = run.registration.register_cloud(scene->vertices);
    ASSERT_EQ(result.outcome, RegistrationOutcome::found) << name;
    // Between the two bottles, on the picture's middle line and below it.
    const Vector3 at = result.instances[0].regions[0].transform * model.view.centre();
    EXPECT_NEAR(std::fabs(at.x() / at.z()), 0.07, 0.04) << name;
    EXPECT_NEAR(std::fabs(at.y() / at.z()), 0.18, 0.06) << name;
  }
}

TEST(RegistrationScenes, ThePlushIsFoundInSinglePictures) {
  const std::filesystem::path folder = kData / "real_plush_squirrel";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data at " << folder;
  const BuiltFromFile model(folder / "model.ply");
  ASSERT_TRUE(model.good);
  const Result<CameraFile> camera = read_camera(folder / "camera.toml");
  ASSERT_TRUE(camera);
  const Intrinsics& c = camera->intrinsics;
  ReadyRegistration run(model.view, static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height));
  ASSERT_EQ(run.fault, nullptr);
  for (const char* name : {"000000.png", "000100.png", "000380.png"}) {
    GreyImage16 picture;
    ASSERT_TRUE(PngReader().read(folder / "depth" / name, picture)) << name;
    DepthFrame frame;
    frame.depth = picture.pixels.data();
    frame.width = frame.stride = picture.width;
    frame.height = picture.height;
    const RegistrationResult& result = run.registration.register_depth(frame, c, SensorDescription());
    ASSERT_EQ(result.outcome, RegistrationOutcome::found) << name;
    // The toy stays on its spot; only what stands on it moves.
    const Vector3 at = result.instances[0].regions[0].transform.translation;
    EXPECT_LT((at - Vector3(0.03, -0.035, 0.63)).norm(), 0.06) << name;
  }
}

}  // namespace
}  // namespace pliant

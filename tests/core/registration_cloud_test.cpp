#include "core/registration/cloud_registration.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/detect/symmetric_eigen.hpp"
#include "core/registration/normal_estimation.hpp"
#include "tests/core/bumpy_object.hpp"

namespace pliant {
namespace {

using testing::AlignedBlock;
using testing::TestCloud;

struct RegistrationFixture {
  explicit RegistrationFixture(std::size_t points, const RegistrationSettings& settings = {})
      : block(CloudRegistration::workspace_bytes(testing::bumpy_model(), points, settings)) {
    EXPECT_EQ(registration.start(testing::bumpy_model(), points, settings, block.span()), nullptr);
  }
  AlignedBlock block;
  CloudRegistration registration;
};

/// The object (other points of its surface than the model's), turned and moved, with balls around it.
std::vector<Point3f> cluttered(const RigidTransform& pose, bool object = true) {
  std::vector<Point3f> points;
  if (object) points = testing::moved(testing::bumpy_cloud(2600, 0.37), pose).positions;
  for (int ball = 0; ball < 3; ++ball)
    for (int i = 0; i < 900; ++i) {
      const double z = 1 - 2 * (i + 0.5) / 900, r = std::sqrt(1 - z * z), a = 2.4 * i;
      const Vector3 d(r * std::cos(a), r * std::sin(a), z);
      points.push_back(to_point(Vector3(0.35 * ball - 0.3, 0.45, 0.9) + (0.05 + 0.02 * ball) * d));
    }
  return points;
}

RigidTransform usual_pose() {
  return testing::test_pose(2.2, Vector3(0.4, -1, 0.3), Vector3(0.1, 0.05, 1.0));
}

TEST(CloudRegistration, FindsTheObjectAndLabelsItRigid) {
  const std::vector<Point3f> scene = cluttered(usual_pose());
  RegistrationFixture fixture(scene.size());
  const RegistrationResult& result = fixture.registration.register_cloud(scene);
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  ASSERT_EQ(result.instances.size(), 1U);
  const InstanceResult& instance = result.instances[0];
  ASSERT_EQ(instance.regions.size(), 1U);
  const RigidTransform& found = instance.regions[0].transform;
  EXPECT_LT(testing::degrees_between(found.rotation, usual_pose().rotation), 0.3);
  EXPECT_LT((found * testing::bumpy_model().centre() - usual_pose() * testing::bumpy_model().centre()).norm(),
            0.0005);
  const std::size_t n = testing::bumpy_model().size();
  ASSERT_EQ(instance.labels.size(), n);
  EXPECT_GT(std::count(instance.labels.begin(), instance.labels.end(), std::int8_t{0}),
            static_cast<long>(0.99 * static_cast<double>(n)));
  for (std::size_t i = 0; i < n; ++i) {
    if (instance.labels[i] != 0) continue;
    EXPECT_LT(
        (to_vector(instance.positions[i]) - usual_pose() * to_vector(testing::bumpy_model().positions()[i]))
            .norm(),
        0.001);
    ASSERT_LT(instance.matches[i], static_cast<std::int32_t>(scene.size()));
  }
  EXPECT_GT(result.scene_keypoints, 1000U);
}

TEST(CloudRegistration, SameBytesEveryTime) {
  const std::vector<Point3f> scene = cluttered(usual_pose());
  RegistrationSettings scalar;
  scalar.kernels = Kernels::scalar;
  RegistrationFixture a(scene.size()), b(scene.size() + 500, scalar);
  const RegistrationResult& first = a.registration.register_cloud(scene);
  const RegistrationResult& again = b.registration.register_cloud(scene);
  ASSERT_EQ(first.instances.size(), 1U);
  ASSERT_EQ(again.instances.size(), 1U);
  EXPECT_EQ(first.instances[0].regions[0].transform.rotation,
            again.instances[0].regions[0].transform.rotation);
  EXPECT_TRUE(std::equal(first.instances[0].labels.begin(), first.instances[0].labels.end(),
                         again.instances[0].labels.begin()));
}

TEST(CloudRegistration, FindsADentAndItsPoints) {
  const RigidTransform pose = usual_pose();
  TestCloud object = testing::bumpy_cloud(2600, 0.37);
  const Vector3 poke = Vector3(0.5, 0.2, -1).normalized();
  std::vector<bool> dented;
  for (Point3f& p : object.positions) {
    const Vector3 d = to_vector(p).normalized();
    const double depth = 0.03 * std::max(0.0, 1 - (d - poke).squaredNorm() / 0.16);
    p = to_point(to_vector(p) - depth * d);
    dented.push_back(depth > 2 * testing::bumpy_model().spacing());
  }
  const std::vector<Point3f> scene = testing::moved(object, pose).positions;
  RegistrationFixture fixture(scene.size());
  const RegistrationResult& result = fixture.registration.register_cloud(scene);
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  const InstanceResult& instance = result.instances[0];
  EXPECT_LT(testing::degrees_between(instance.regions[0].transform.rotation, pose.rotation), 0.5);
  int inside = 0, right = 0, false_deformed = 0;
  std::vector<int> uses(scene.size(), 0);
  for (std::size_t i = 0; i < testing::bumpy_model().size(); ++i) {
    const Vector3 d = to_vector(testing::bumpy_model().positions()[i]).normalized();
    const double square = (d - poke).squaredNorm();
    const double depth = 0.03 * std::max(0.0, 1 - square / 0.16);
    if (depth > 2 * testing::bumpy_model().spacing()) {
      ++inside;
      right += instance.labels[i] == kDeformed ? 1 : 0;
    }
    if (square > 0.2 && instance.labels[i] == kDeformed) ++false_deformed;
    if (instance.labels[i] == kDeformed && instance.matches[i] >= 0)
      ++uses[static_cast<std::size_t>(instance.matches[i])];
  }
  EXPECT_GT(right, 0.85 * inside) << inside;
  EXPECT_LT(false_deformed, 10);
  EXPECT_EQ(*std::max_element(uses.begin(), uses.end()), 1)
      << "a scene point must serve one deformed point only";
}

TEST(CloudRegistration, FindsSeveralInstancesEachWithItsOwnRegions) {
  const RigidTransform here = usual_pose(),
                       there = testing::test_pose(-1.0, Vector3(1, 0.2, 0.3), Vector3(0.6, -0.2, 1.2));
  std::vector<Point3f> scene = cluttered(here);
  const std::vector<Point3f> other = testing::moved(testing::bumpy_cloud(2600, 0.7), there).positions;
  scene.insert(scene.end(), other.begin(), other.end());
  RegistrationSettings settings;
  settings.max_instances = 4;
  RegistrationFixture fixture(scene.size(), settings);
  const RegistrationResult& result = fixture.registration.register_cloud(scene);
  ASSERT_EQ(result.instances.size(), 2U);
  for (const RigidTransform& pose : {here, there}) {
    double nearest = 1e9;
    for (const InstanceResult& instance : result.instances)
      nearest = std::min(nearest, (instance.regions[0].transform * testing::bumpy_model().centre() -
                                   pose * testing::bumpy_model().centre())
                                      .norm());
    EXPECT_LT(nearest, 0.002);
  }
}

TEST(CloudRegistration, BallsOfTheObjectsSizeAreNotTheObject) {
  // Such a ball lies within the tolerance of nearly half of the object, whatever its attitude.
  for (const double radius : {0.08, 0.09, 0.1, 0.11, 0.12}) {
    std::vector<Point3f> scene;
    for (int ball = 0; ball < 3; ++ball)
      for (int i = 0; i < 3000; ++i) {
        const double z = 1 - 2 * (i + 0.5) / 3000, r = std::sqrt(1 - z * z), a = 2.4 * i;
        scene.push_back(to_point(Vector3(0.35 * ball - 0.3, 0.45, 0.9) +
                                 radius * Vector3(r * std::cos(a), r * std::sin(a), z)));
      }
    RegistrationFixture fixture(scene.size());
    EXPECT_EQ(fixture.registration.register_cloud(scene).outcome, RegistrationOutcome::not_found) << radius;
  }
}

TEST(CloudRegistration, SaysNothingOfASceneWithoutTheObject) {
  const std::vector<Point3f> scene = cluttered(usual_pose(), false);
  RegistrationFixture fixture(scene.size());
  const RegistrationResult& result = fixture.registration.register_cloud(scene);
  EXPECT_EQ(result.outcome, RegistrationOutcome::not_found);
  EXPECT_TRUE(result.instances.empty());
}

TEST(CloudRegistration, ClearAnswersToBadClouds) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  RegistrationFixture fixture(6000);
  const auto outcome = [&](const std::vector<Point3f>& scene) {
    return fixture.registration.register_cloud(scene).outcome;
  };
  EXPECT_EQ(outcome({}), RegistrationOutcome::no_points);
  EXPECT_EQ(outcome(std::vector<Point3f>(500, Point3f{kNan, 0, 0})), RegistrationOutcome::no_points);
  EXPECT_EQ(outcome({{0, 0, 0}, {0.1F, 0, 0}, {0, kInf, 0}, {0, 0.1F, 0.1F}}),
            RegistrationOutcome::too_few_points);
  EXPECT_EQ(outcome(std::vector<Point3f>(3000, Point3f{0.1F, 0.2F, 0.3F})), RegistrationOutcome::flat);
  EXPECT_EQ(outcome(std::vector<Point3f>(6001, Point3f{0.1F, 0.2F, 0.3F})),
            RegistrationOutcome::too_many_points);
  std::vector<Point3f> plane, line, ball;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j)
      plane.push_back({0.01F * static_cast<float>(i), 0.01F * static_cast<float>(j), 1});
  for (int i = 0; i < 3000; ++i) line.push_back({0.0003F * static_cast<float>(i), 0, 0});
  for (int i = 0; i < 3000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 3000, r = std::sqrt(1 - z * z), a = 2.4 * i;
    ball.push_back(to_point(0.12 * Vector3(r * std::cos(a), r * std::sin(a), z)));
  }
  EXPECT_EQ(outcome(plane), RegistrationOutcome::flat);
  EXPECT_EQ(outcome(line), RegistrationOutcome::flat);
  EXPECT_EQ(outcome(ball), RegistrationOutcome::not_found);
  std::vector<Point3f> millimetres = cluttered(usual_pose());
  for (Point3f& p : millimetres) p = {1000 * p.x, 1000 * p.y, 1000 * p.z};
  EXPECT_EQ(outcome(millimetres), RegistrationOutcome::wrong_size);
  EXPECT_GT(fixture.registration.register_cloud(millimetres).size_ratio, 900);
  for (int k = 0; k <= static_cast<int>(RegistrationOutcome::too_many_points); ++k)
    EXPECT_GT(std::string(describe(static_cast<RegistrationOutcome>(k))).size(), 4U);
}

TEST(CloudRegistration, StraysDuplicatesAndGapsDoNoHarm) {
  std::vector<Point3f> scene = cluttered(usual_pose());
  const std::size_t n = scene.size();
  for (std::size_t i = 0; i < 500; ++i) scene.push_back(scene[i]);
  scene.push_back({1e6F, -1e6F, 1e6F});
  scene.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  for (int i = 0; i < 400; ++i) scene.push_back(scene[n - 1]);
  RegistrationFixture fixture(scene.size());
  const RegistrationResult& result = fixture.registration.register_cloud(scene);
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  EXPECT_LT(
      testing::degrees_between(result.instances[0].regions[0].transform.rotation, usual_pose().rotation),
      0.3);
}

TEST(CloudRegistration, ComputesDescriptorsBeyondTheStoredOnes) {
  const std::vector<Point3f> scene = cluttered(usual_pose());
  RegistrationSettings settings;
  settings.model_keypoints = 2000;  // the model holds 1,024
  settings.scene_keypoints = 700;
  RegistrationFixture fixture(scene.size(), settings);
  const RegistrationResult& result = fixture.registration.register_cloud(scene);
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  EXPECT_EQ(result.model_keypoints, 2000U);
  EXPECT_NEAR(result.scene_keypoints, 700, 40);
}

TEST(CloudRegistration, TellsTheCallerWhenTheBlockIsTooSmall) {
  AlignedBlock block(4096);
  CloudRegistration registration;
  EXPECT_NE(registration.start(testing::bumpy_model(), 5000, {}, block.span()), nullptr);
  EXPECT_NE(registration.start(ModelView(), 5000, {}, block.span()), nullptr);
}

TEST(CloudRegistration, EveryStageIsReported) {
  const std::vector<Point3f> scene = cluttered(usual_pose());
  RegistrationFixture fixture(scene.size());
  std::array<int, kRegistrationStageCount> calls{};
  fixture.registration.observe({[](void* context, RegistrationStage stage, bool) {
                                  ++(*static_cast<std::array<int, kRegistrationStageCount>*>(
                                      context))[static_cast<std::size_t>(stage)];
                                },
                                &calls});
  static_cast<void>(fixture.registration.register_cloud(scene));
  for (const int c : calls) EXPECT_GT(c, 0);
}

TEST(NormalOrientation, TurnsAClosedSurfaceOutwardWhateverTheSigns) {
  const TestCloud cloud = testing::bumpy_cloud(3000);
  AlignedBlock block(4 << 20);
  Workspace workspace(block.span());
  PointGrid grid;
  grid.lay_out(workspace, cloud.positions.size());
  ASSERT_TRUE(grid.build(cloud.positions, 0.01));
  NormalOrientation orientation;
  orientation.lay_out(workspace, cloud.positions.size());
  std::vector<Normal16> normals(cloud.positions.size());
  estimate_normals(grid, cloud.positions, 0.02, normals);
  orientation.outward(cloud.positions, grid, 0.02, normals);
  int right = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Normal16 &a = normals[i], &b = cloud.normals[i];
    right += a.x * b.x + a.y * b.y + a.z * b.z > 0.8 * 16384 * 16384 ? 1 : 0;
  }
  EXPECT_GT(right, 0.99 * static_cast<double>(normals.size()));
}

TEST(SymmetricEigen, SolvesAndOrders) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> spread(-1, 1);
  for (int k = 0; k < 200; ++k) {
    Matrix3 b;
    for (int i = 0; i < 9; ++i) b(i / 3, i % 3) = spread(random);
    const Matrix3 m = b + b.transpose();
    const SymmetricEigen eigen = symmetric_eigen(m);
    EXPECT_LE(eigen.values(0), eigen.values(1));
    EXPECT_LE(eigen.values(1), eigen.values(2));
    for (int i = 0; i < 3; ++i)
      EXPECT_LT((m * eigen.vectors.col(i) - eigen.values(i) * eigen.vectors.col(i)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace pliant

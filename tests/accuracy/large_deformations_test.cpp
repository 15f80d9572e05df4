// Limbs that turned by more than their own width: every point must still be found where it went.
#include <gtest/gtest.h>

#include <numbers>

#include <Eigen/Geometry>

#include "core/detect/point_grid.hpp"
#include "tests/accuracy/registration_runs.hpp"

namespace pliant {
namespace {

constexpr double kWithin = 0.03;  // of the object's size

/// How much of a result lies where it should: `rest` is a point of the undeformed surface, `now` where it
/// went.
class Placement {
 public:
  Placement(const ModelView& model, const InstanceResult& instance) : model_(model), instance_(instance) {
    Workspace workspace(grid_block_.bytes);
    grid_.lay_out(workspace, model.size());
    EXPECT_TRUE(grid_.build(model.positions(), 2 * model.spacing()));
  }
  void check(const Point3f& rest, const Point3f& now) {
    float square = 0;
    const std::uint32_t i = grid_.nearest(rest, static_cast<float>(8 * model_.spacing()), square);
    ASSERT_NE(i, PointGrid::kNone);
    const double off = (to_vector(instance_.positions[i]) - to_vector(now)).norm();
    // The nearest model point lies a little beside it.
    within_ += off < kWithin * 2 * model_.radius() + std::sqrt(static_cast<double>(square)) ? 1 : 0;
    ++all_;
  }
  [[nodiscard]] double share() const { return within_ / std::max(1.0, all_); }

 private:
  const ModelView& model_;
  const InstanceResult& instance_;
  AlignedBlock grid_block_{1 << 20};
  PointGrid grid_;
  double within_ = 0, all_ = 0;
};

/// A lumpy ball with an arm, both of them lumpy lest they slide, as points with normals.
Geometry ball_with_arm() {
  Geometry geometry;
  const auto add = [&](const Vector3& at, const Vector3& normal) {
    geometry.vertices.push_back(to_point(at));
    geometry.normals.push_back(to_point(normal.normalized()));
  };
  const auto ball = [](const Vector3& d) {
    return 0.1 + 0.012 * std::sin(5 * d.x() + 1) * std::cos(4 * d.y()) + 0.01 * std::sin(6 * d.z());
  };
  const auto arm = [](double x, double angle) {
    const double thick = x > 0.28 ? std::sqrt(std::max(0.0, 1 - (x - 0.28) * (x - 0.28) / (0.02 * 0.02))) : 1;
    return thick *
           (0.026 - 0.03 * (x - 0.1) + 0.003 * std::sin(60 * x) + 0.004 * std::cos(2 * angle + 20 * x));
  };
  for (int i = 0; i < 6000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 6000, r = std::sqrt(1 - z * z), a = 2.39996323 * i;
    const Vector3 d(r * std::cos(a), r * std::sin(a), z), at = ball(d) * d;
    if (at.x() > 0.09 && std::hypot(at.y(), at.z()) < arm(0.1, std::atan2(at.z(), at.y()))) continue;
    const Vector3 u = d.unitOrthogonal(), v = d.cross(u);
    const auto near = [&](const Vector3& step) {
      const Vector3 e = (d + 1e-4 * step).normalized();
      return Vector3(ball(e) * e - at);
    };
    add(at, near(u).cross(near(v)));
  }
  for (double x = 0.08; x < 0.2999; x += 0.0038)
    for (int k = 0; k < 40; ++k) {
      const double a = 2 * std::numbers::pi * (k + 0.5 * std::fmod(x / 0.0038, 2.0)) / 40;
      const auto surface = [&](double along, double angle) {
        return Vector3(along, arm(along, angle) * std::cos(angle), arm(along, angle) * std::sin(angle));
      };
      const Vector3 at = surface(x, a);
      if (at.norm() < ball(at.normalized())) continue;
      add(at, (surface(x, a + 1e-4) - at).cross(Vector3(surface(std::min(0.2999, x + 1e-4), a) - at)) * -1);
    }
  return geometry;
}

class TurnedArm : public ::testing::TestWithParam<double> {};

TEST_P(TurnedArm, IsFoundWhereItWent) {
  const Geometry rest = ball_with_arm();
  const BuiltFromFile model(rest);
  ASSERT_TRUE(model.good);
  const double turn = GetParam() * std::numbers::pi / 180;
  const RigidTransform pose = {rotation_from_quaternion({0.8, 0.3, -0.5, 0.142}), {0.1, -0.05, 0.9}};
  const RigidTransform straight = {orthonormalised(pose.rotation), pose.translation};
  std::vector<Point3f> scene;
  for (const Point3f& p : rest.vertices) {
    // The arm bends about the shoulder within 3 cm.
    const double share = std::clamp((static_cast<double>(p.x) - 0.105) / 0.03, 0.0, 1.0);
    const bool of_arm = p.x > 0.105F && std::hypot(p.y, p.z) < 0.035F;
    const double angle = of_arm ? share * turn : 0;
    const Vector3 shoulder(0.11, 0, 0), axis = Vector3(0, 0.6, 0.8);
    const Matrix3 bent =
        rotation_from_quaternion({std::cos(angle / 2), axis.x() * std::sin(angle / 2),
                                  axis.y() * std::sin(angle / 2), axis.z() * std::sin(angle / 2)});
    scene.push_back(to_point(straight * (bent * (to_vector(p) - shoulder) + shoulder)));
  }
  ReadyRegistration run(model.view, scene.size());
  ASSERT_EQ(run.fault, nullptr);
  const RegistrationResult& result = run.registration.register_cloud(scene);
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  Placement ball(model.view, result.instances[0]), arm(model.view, result.instances[0]);
  for (std::size_t i = 0; i < scene.size(); ++i)
    (rest.vertices[i].x > 0.135F ? arm : ball).check(rest.vertices[i], scene[i]);
  EXPECT_GT(ball.share(), 0.98);
  EXPECT_GT(arm.share(), 0.95);
}

INSTANTIATE_TEST_SUITE_P(Degrees, TurnedArm, ::testing::Values(0.0, 25.0, 50.0, 75.0));

struct LargeCase {
  const char* folder;
  double least_share;
};

void PrintTo(const LargeCase& c, std::ostream* out) {
  *out << c.folder;
}

class LargeDeformation : public ::testing::TestWithParam<LargeCase> {};

TEST_P(LargeDeformation, LeavesPointsWhereTheyWent) {
  const std::filesystem::path folder =
      std::filesystem::path(PLIANT_SHARED_DATA) / "cases" / GetParam().folder;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data at " << folder;
  const BuiltFromFile model(folder / "model.ply");
  ASSERT_TRUE(model.good);
  const Result<Geometry> scene = read_geometry(folder / "scene.ply");
  const Result<Geometry> clean = read_geometry(folder / "scene_clean.ply");
  ASSERT_TRUE(scene);
  ASSERT_TRUE(clean);
  ReadyRegistration run(model.view, scene->vertices.size());
  ASSERT_EQ(run.fault, nullptr);
  const RegistrationResult& result = run.registration.register_cloud(scene->vertices);
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  Placement placement(model.view, result.instances[0]);
  const std::vector<TruePoint> truth = read_true_points(folder / "scene_gt.csv");
  ASSERT_EQ(truth.size(), clean->vertices.size());
  for (std::size_t k = 0; k < truth.size(); ++k) placement.check(truth[k].rest, clean->vertices[k]);
  EXPECT_GT(placement.share(), GetParam().least_share);
}

INSTANTIATE_TEST_SUITE_P(Shared, LargeDeformation,
                         ::testing::Values(LargeCase{"large_wolf_1", 0.95}, LargeCase{"large_wolf_4", 0.95},
                                           LargeCase{"large_cheburashka_02", 0.9},
                                           LargeCase{"large_cheburashka_07", 0.95},
                                           LargeCase{"large_samba_2", 0.9}, LargeCase{"large_samba_8", 0.9}));

}  // namespace
}  // namespace pliant

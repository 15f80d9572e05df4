// What no registration may do: take more than twice the usual work over an awkward scene.
#include <gtest/gtest.h>

#include <random>

#include "tests/accuracy/registration_runs.hpp"
#include "tests/core/bumpy_object.hpp"

namespace pliant {
namespace {

constexpr std::size_t kScenePoints = 9000;

RigidTransform usual_pose() {
  return testing::test_pose(2.2, Vector3(0.4, -1, 0.3), Vector3(0.1, 0.05, 1.0));
}

/// Balls of the object's size: every descriptor of a ball is the same, and every one fits everywhere.
std::vector<Point3f> balls(std::size_t points, int count) {
  std::vector<Point3f> out;
  const std::size_t each = points / static_cast<std::size_t>(count);
  for (int ball = 0; ball < count; ++ball)
    for (std::size_t i = 0; i < each; ++i) {
      const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(each);
      const double r = std::sqrt(1 - z * z), a = 2.4 * static_cast<double>(i);
      out.push_back(to_point(Vector3(0.35 * ball - 0.3, 0.45, 0.9) +
                             0.1 * Vector3(r * std::cos(a), r * std::sin(a), z)));
    }
  return out;
}

/// Nothing but clutter: bumps of every size on a surface that is none of the object's.
std::vector<Point3f> clutter(std::size_t points, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  double wave[12][4];
  for (auto& w : wave)
    for (double& x : w) x = unit(random);
  std::vector<Point3f> out;
  for (std::size_t i = 0; i < points; ++i) {
    const double u = 0.4 * unit(random), v = 0.4 * unit(random);
    double z = 0;
    for (const auto& w : wave) z += 0.012 * std::sin(60 * (w[0] * u + w[1] * v) + 3 * w[2]) * w[3];
    out.push_back(to_point(Vector3(u, v, 1 + z)));
  }
  return out;
}

/// The object among balls.
std::vector<Point3f> usual_scene() {
  std::vector<Point3f> points = balls(kScenePoints * 2 / 3, 3);
  for (const Point3f& p :
       testing::moved(testing::bumpy_cloud(kScenePoints - points.size(), 0.37), usual_pose()).positions)
    points.push_back(p);
  return points;
}

/// The model's own points three times over, a hundredth of its size apart: every match is right, or right for
/// a neighbour.
std::vector<Point3f> consistent_scene() {
  std::vector<Point3f> points;
  for (int copy = 0; copy < 3; ++copy)
    for (const Point3f& p : testing::bumpy_model().positions()) {
      const Vector3 q = usual_pose() * (to_vector(p) + Vector3(0.002 * copy, 0, 0));
      points.push_back(to_point(q));
    }
  return points;
}

/// Work of a registration; prints its thread time, the model's own stages left out, beside it.
std::uint64_t work_of(const char* name, const std::vector<Point3f>& scene, RegistrationOutcome expected) {
  ReadyRegistration run(testing::bumpy_model(), scene.size());
  EXPECT_EQ(run.fault, nullptr) << name;
  StageClock clock;
  run.registration.observe(clock.observer());
  clock.begin();
  const RegistrationResult& result = run.registration.register_cloud(scene);
  EXPECT_EQ(result.outcome, expected) << name;
  std::printf("%-24s %6.1f million instructions, about, %5.1f ms\n", name,
              static_cast<double>(result.work) * 1e-6, clock.total());
  return result.work;
}

TEST(BoundedWork, AwkwardScenesTakeAtMostTwiceTheUsualWork) {
  const std::uint64_t usual = work_of("usual", usual_scene(), RegistrationOutcome::found);
  const std::uint64_t most = 2 * usual;
  EXPECT_GT(usual, 50000000U);
  EXPECT_LE(work_of("all descriptors equal", balls(kScenePoints, 3), RegistrationOutcome::not_found), most);
  EXPECT_LE(work_of("nothing but clutter", clutter(kScenePoints, 1), RegistrationOutcome::not_found), most);
  EXPECT_LE(work_of("all matches consistent", consistent_scene(), RegistrationOutcome::found), most);
}

TEST(BoundedWork, IsTheSameEachTime) {
  EXPECT_EQ(work_of("usual", usual_scene(), RegistrationOutcome::found),
            work_of("once more", usual_scene(), RegistrationOutcome::found));
}

}  // namespace
}  // namespace pliant

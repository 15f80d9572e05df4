// A figure whose joints have hardly moved: its parts must still be told apart.
#include <gtest/gtest.h>

#include <array>

#include <Eigen/Geometry>

#include "tests/accuracy/registration_runs.hpp"

namespace pliant {
namespace {

/// A turn about a fixed axis.
struct Hinge {
  Vector3 axis = Vector3::UnitZ(), through = Vector3::Zero();
  double angle = 0;  // radians

  /// The turn that a rigid motion makes; what it slides along its axis is left out.
  explicit Hinge(const RigidTransform& motion) {
    const Vector3 turn = small_vector_from_rotation(motion.rotation);
    angle = 2 * std::atan(turn.norm() / 2);  // Cayley's form
    axis = turn / turn.norm();
    // The point nearest to the origin that stays: c = (t + cot(a/2) axis × t) / 2 for t across the axis.
    const Vector3 across = motion.translation - axis.dot(motion.translation) * axis;
    through = 0.5 * (across + axis.cross(across) / std::tan(angle / 2));
  }
  [[nodiscard]] RigidTransform by(double turned) const {
    RigidTransform result;
    result.rotation = rotation_from_small_vector(2 * std::tan(turned / 2) * axis);
    result.translation = through - result.rotation * through;
    return result;
  }
};

/// The case's figure in another attitude: waist and elbow bent by these angles (radians) about the same
/// hinges.
struct BentFigure {
  std::vector<Point3f> model, scene;
  std::vector<int> part;  // of each vertex: 1 legs, 2 upper body, 3 forearm, 4 between
  std::array<RigidTransform, 3> poses;
};

BentFigure bend(const std::filesystem::path& folder, double waist_angle, double elbow_angle) {
  BentFigure figure;
  const Result<Geometry> model = read_geometry(folder / "model.ply");
  const Result<Geometry> scene = read_geometry(folder / "scene.ply");
  const std::vector<RigidTransform> truth = read_true_poses(folder / "gt_pose.txt");
  if (!model || !scene || truth.size() != 3) return figure;
  figure.model = model->vertices;
  const RigidTransform base = truth[0];
  const Hinge waist(base.inverse() * truth[1]), elbow(truth[1].inverse() * truth[2]);
  const auto posed = [&](double at_waist, double at_elbow) {
    return base * waist.by(at_waist) * elbow.by(at_elbow);
  };
  figure.poses = {base, posed(waist_angle, 0), posed(waist_angle, elbow_angle)};
  const std::vector<TruePoint> true_points = read_true_points(folder / "scene_gt.csv");
  for (std::size_t k = 0; k < true_points.size() && k < scene->vertices.size(); ++k) {
    const int label = true_points[k].label;
    const auto index = static_cast<std::size_t>(true_points[k].index);
    if (index >= figure.model.size()) continue;
    const Vector3 p = to_vector(figure.model[index]), q = to_vector(scene->vertices[k]);
    RigidTransform pose = label <= 3 && label >= 1 ? figure.poses[static_cast<std::size_t>(label - 1)] : base;
    if (label == 4) {
      // Between two parts: bent by the share of a hinge's angle that the case bent it by.
      double nearest = 1e9;
      for (int joint = 0; joint < 2; ++joint)
        for (int step = 0; step <= 40; ++step) {
          const double share = step / 40.0;
          const RigidTransform bent =
              joint == 0 ? posed(share * waist.angle, 0) : posed(waist.angle, share * elbow.angle);
          const double off = (bent * p - q).norm();
          if (off >= nearest) continue;
          nearest = off;
          pose = joint == 0 ? posed(share * waist_angle, 0) : posed(waist_angle, share * elbow_angle);
        }
    }
    const Vector3 placed = pose * p;
    figure.scene.push_back(to_point(placed));
    figure.part.push_back(label);
  }
  return figure;
}

TEST(SmallAngles, TheFiguresPartsAreToldApart) {
  const std::filesystem::path folder = std::filesystem::path(PLIANT_SHARED_DATA) / "cases" / "c_humanoid";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared data at " << folder;
  const BentFigure figure = bend(folder, 12 * M_PI / 180, 20 * M_PI / 180);
  ASSERT_GT(figure.scene.size(), 10000U);
  const BuiltFromFile model(folder / "model.ply");
  ASSERT_TRUE(model.good);
  ReadyRegistration run(model.view, figure.scene.size());
  ASSERT_EQ(run.fault, nullptr);
  const RegistrationResult& result = run.registration.register_cloud(figure.scene);
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  const InstanceResult& instance = result.instances[0];
  // Which part a model point belongs to: that of the scene's vertex that stands where its part's pose takes
  // it.
  for (std::size_t k = 0; k < 3; ++k) {
    double degrees = 1e9, metres = 1e9;
    int best = -1;
    for (const RegionResult& region : instance.regions) {
      const double d = degrees_between(region.transform.rotation, figure.poses[k].rotation);
      if (d >= degrees) continue;
      degrees = d;
      best = region.id;
      metres = (region.transform * model.view.centre() - figure.poses[k] * model.view.centre()).norm();
    }
    EXPECT_LT(degrees, 1.5) << k;
    EXPECT_LT(metres, 0.002 + 0.3 * degrees * M_PI / 180) << k;  // at the part itself the lever is shorter
    // Of the scene points of this part, those that lie on this region's model points.
    std::size_t all = 0, whole = 0;
    const RigidTransform back = figure.poses[k].inverse();
    for (std::size_t i = 0; i < figure.scene.size(); i += 7) {
      if (figure.part[i] != static_cast<int>(k + 1)) continue;
      const Vector3 p = back * to_vector(figure.scene[i]);
      std::size_t nearest = 0;
      double square = 1e9;
      for (std::size_t m = 0; m < model.view.size(); ++m) {
        const Vector3 gap = to_vector(model.view.positions()[m]) - p;
        if (gap.dot(gap) < square) {
          square = gap.dot(gap);
          nearest = m;
        }
      }
      ++all;
      whole += instance.labels[nearest] == best ? 1U : 0U;
    }
    EXPECT_GT(static_cast<double>(whole), 0.85 * static_cast<double>(all)) << k;
  }
}

}  // namespace
}  // namespace pliant

// Plain things of about the object's size are not the object, not even of one that is nearly round itself.
#include <gtest/gtest.h>

#include "tests/accuracy/plain_shapes.hpp"
#include "tests/accuracy/registration_runs.hpp"
#include "tests/core/bumpy_object.hpp"
#include "tests/frame_of.hpp"

namespace pliant {
namespace {

/// The lumpy object, 30 cm across, its lumps lower by `share`.
ScaledMesh lumpy(double share) {
  const ScaledMesh unit = ball(1);
  Geometry geometry = geometry_of(unit);
  for (std::size_t i = 0; i < unit.vertices.size(); ++i) {
    const Vector3 d = unit.vertices[i].normalized();
    geometry.vertices[i] = to_point((0.09 + share * (testing::bumpy_radius(d) - 0.09)) * d);
  }
  return scaled(geometry, kSize);
}

TEST(PlainShapes, AreNotTakenForAnObjectOfTheirSize) {
  const Intrinsics camera = structure_camera();
  simulated::DisparityImage image(camera);
  for (const double share : {1.0, 0.5}) {
    const ScaledMesh target = lumpy(share);
    const BuiltFromFile model(geometry_of(target));
    ASSERT_TRUE(model.good);
    ReadyRegistration run(model.view, table_size(camera.width, camera.height));
    ASSERT_EQ(run.fault, nullptr);
    for (const PlainShape shape : kPlainShapes)
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const std::vector<std::uint16_t> picture = picture_like(target, shape, seed, image);
        const RegistrationResult& result =
            run.registration.register_depth(test::frame_of(picture, camera), camera, SensorDescription());
        EXPECT_NE(result.outcome, RegistrationOutcome::found)
            << name_of(shape) << ", seed " << seed << ", lumps " << share;
      }
  }
}

TEST(PlainShapes, TheObjectItselfIsFoundAmongBallsOfItsSize) {
  const ScaledMesh target = lumpy(0.5);
  const std::vector<ScaledMesh> others = {ball(0.05), ball(0.09), ball(0.1)};
  const BuiltFromFile model(geometry_of(target));
  ASSERT_TRUE(model.good);
  const Intrinsics camera = structure_camera();
  ReadyRegistration run(model.view, table_size(camera.width, camera.height));
  ASSERT_EQ(run.fault, nullptr);
  ViewMaker maker(target, others);
  int right = 0, wrong = 0, made = 0;
  for (std::uint64_t seed = 1; made < 12; ++seed) {
    View view;
    if (!maker.make(seed, view)) continue;
    ++made;
    const RegistrationResult& with =
        run.registration.register_depth(test::frame_of(view.with, camera), camera, SensorDescription());
    if (with.outcome == RegistrationOutcome::found) {
      const RigidTransform& pose = with.instances[0].regions[0].transform;
      const bool good = degrees_between(pose.rotation, view.pose.rotation) < 10 &&
                        (pose.translation - view.pose.translation).norm() < 0.01;
      (good ? right : wrong) += 1;
    }
    const RegistrationResult& without =
        run.registration.register_depth(test::frame_of(view.without, camera), camera, SensorDescription());
    EXPECT_NE(without.outcome, RegistrationOutcome::found) << seed;
  }
  // Where six balls crowd about it, it may be missed; and once, in the attitude, mistaken.
  EXPECT_GE(right, 8);
  EXPECT_LE(wrong, 1);
}

}  // namespace
}  // namespace pliant

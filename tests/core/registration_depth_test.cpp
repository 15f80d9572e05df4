#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/registration/cloud_registration.hpp"
#include "tests/core/bumpy_object.hpp"
#include "tests/frame_of.hpp"

namespace pliant {
namespace {

using testing::AlignedBlock;

/// A picture of the object at these poses before a wall, and a registration that is ready for it.
struct DepthFixture {
  explicit DepthFixture(const std::vector<RigidTransform>& poses, std::uint32_t most_instances = 1)
      : block(0) {
    testing::TestCloud all;
    for (const RigidTransform& pose : poses) {
      const testing::TestCloud one = testing::moved(testing::bumpy_cloud(60000), pose);
      all.positions.insert(all.positions.end(), one.positions.begin(), one.positions.end());
      all.normals.insert(all.normals.end(), one.normals.begin(), one.normals.end());
    }
    picture = testing::depth_picture(camera, all, 1.2, 1, 0.001);
    frame = test::frame_of(picture, camera);
    settings.max_instances = most_instances;
    block =
        AlignedBlock(CloudRegistration::workspace_bytes(testing::bumpy_model(), picture.size(), settings));
    EXPECT_EQ(registration.start(testing::bumpy_model(), picture.size(), settings, block.span()), nullptr);
  }
  const RegistrationResult& run() { return registration.register_depth(frame, camera, SensorDescription()); }
  Intrinsics camera = testing::small_camera();
  std::vector<std::uint16_t> picture;
  DepthFrame frame;
  RegistrationSettings settings;
  AlignedBlock block;
  CloudRegistration registration;
};

RigidTransform usual_pose() {
  return testing::test_pose(1.1, Vector3(0.2, 1, 0.1), Vector3(0.02, 0.01, 0.7));
}

TEST(DepthRegistration, FindsTheObjectAndSaysWhatItCannotSee) {
  DepthFixture fixture({usual_pose()});
  const RegistrationResult& result = fixture.run();
  ASSERT_EQ(result.outcome, RegistrationOutcome::found);
  const InstanceResult& instance = result.instances[0];
  EXPECT_LT(testing::degrees_between(instance.regions[0].transform.rotation, usual_pose().rotation), 2);
  // About half of it is turned away.
  EXPECT_GT(instance.unobserved, 0.3 * static_cast<double>(testing::bumpy_model().size()));
  EXPECT_LT(instance.unobserved, 0.7 * static_cast<double>(testing::bumpy_model().size()));
  for (std::size_t i = 0; i < instance.labels.size(); ++i)
    if (instance.labels[i] == 0 && instance.matches[i] >= 0) {
      ASSERT_LT(instance.matches[i], 320 * 240);
      EXPECT_NE(fixture.picture[static_cast<std::size_t>(instance.matches[i])], 0);
    }
  fixture.frame.height = 4000;
  EXPECT_NE(fixture.run().outcome, RegistrationOutcome::found);
}

TEST(DepthRegistration, FindsEveryInstanceOnceAndNoOther) {
  const std::vector<RigidTransform> poses = {
      testing::test_pose(1.1, Vector3(0.2, 1, 0.1), Vector3(-0.2, 0.02, 0.75)),
      testing::test_pose(2.5, Vector3(1, 0.3, -0.4), Vector3(0.2, -0.03, 0.8))};
  DepthFixture fixture(poses, 5);
  const std::vector<std::uint16_t> before = fixture.picture;
  const RegistrationResult& result = fixture.run();
  ASSERT_EQ(result.instances.size(), poses.size());
  const Vector3& centre = testing::bumpy_model().centre();
  for (const RigidTransform& pose : poses) {
    const auto there = [&](const InstanceResult& instance) {
      return (instance.regions[0].transform * centre - pose * centre).norm() < 0.01;
    };
    ASSERT_EQ(std::count_if(result.instances.begin(), result.instances.end(), there), 1);
    const InstanceResult& instance = *std::find_if(result.instances.begin(), result.instances.end(), there);
    EXPECT_LT(testing::degrees_between(instance.regions[0].transform.rotation, pose.rotation), 5);
  }
  EXPECT_EQ(fixture.picture, before);
}

TEST(DepthRegistration, EveryStageIsReported) {
  DepthFixture fixture({usual_pose()});
  std::array<int, kRegistrationStageCount> calls{};
  fixture.registration.observe({[](void* context, RegistrationStage stage, bool) {
                                  ++(*static_cast<std::array<int, kRegistrationStageCount>*>(
                                      context))[static_cast<std::size_t>(stage)];
                                },
                                &calls});
  ASSERT_EQ(fixture.run().outcome, RegistrationOutcome::found);
  for (const int c : calls) EXPECT_GT(c, 0);
  EXPECT_GT(fixture.run().work, 10000000U);
}

}  // namespace
}  // namespace pliant

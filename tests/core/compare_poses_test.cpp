#include "core/track/compare_poses.hpp"

#include <gtest/gtest.h>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;
using synthetic::TrackScene;

/// A bar before a far wall, drawn where `pose_` has it.
class ComparePoses : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_.place(pose_);
    scene_.see_body(pose_);
  }
  double worse(const RigidTransform& own, const RigidTransform& other, const PatchSet* patches = nullptr) {
    const Sighting sighting(scene_.tables, scene_.surface, scene_.projector, scene_.tolerance);
    return worse_by(scene_.tables, scene_.patches, sighting, scene_.points, {0, patches}, own, other);
  }
  [[nodiscard]] RigidTransform shifted(const Vector3& shift) const {
    return {pose_.rotation, pose_.translation + shift};
  }

  TrackScene scene_{synthetic::two_part_bar(), 0.005};
  RigidTransform pose_ = synthetic::pose_at({0, 0, 0.6}, {1, 0, 0}, 0.4);
};

TEST_F(ComparePoses, OnePoseIsAsGoodAsItself) {
  EXPECT_EQ(worse(pose_, pose_), 0);
}

TEST_F(ComparePoses, APoseOffTheSurfaceIsWorseTheFartherItIs) {
  const double near = worse(pose_, shifted({0, 0, 0.002})), far = worse(pose_, shifted({0, 0, 0.004}));
  EXPECT_GT(near, 0.1);
  EXPECT_GT(far, near + 0.1);
  EXPECT_LE(worse(shifted({0, 0, 0.002}), pose_), 0);
}

TEST_F(ComparePoses, AsksNoFurtherOnceItIsClear) {
  const Sighting sighting(scene_.tables, scene_.surface, scene_.projector, scene_.tolerance);
  const auto ask = [&](const RigidTransform& other, double clear) {
    return worse_by(scene_.tables, scene_.patches, sighting, scene_.points, {0, nullptr, true, clear}, pose_,
                    other);
  };
  const RigidTransform far = shifted({0, 0, 0.004}), near = shifted({0, 0, 0.001});
  ASSERT_GT(worse(pose_, far), 0.4);
  EXPECT_GT(ask(far, 0.3), 0.3);
  EXPECT_NE(ask(far, 0.3), worse(pose_, far)) << "a few points, not all";
  ASSERT_LT(worse(pose_, near), 0.3);
  EXPECT_EQ(ask(near, 0.3), worse(pose_, near));
}

TEST_F(ComparePoses, AWholeLimitAwayCostsNoMoreThanTheLimit) {
  EXPECT_LE(worse(pose_, shifted({0, 0, 0.03})), 1);
}

/// A flat bar slides along itself: its readings are as near, its outline is not.
TEST(ComparePosesOfASlab, TheOutlineTellsWhatTheSurfaceCannot) {
  Geometry slab = synthetic::two_part_bar();
  for (Point3f& p : slab.vertices) p.z *= 0.35F;
  slab.normals.clear();  // the model's builder takes them from the triangles
  TrackScene scene(slab, 0.004);
  const RigidTransform pose = synthetic::pose_at({0, 0, 0.6}, {1, 0, 0}, 0.0);
  scene.place(pose);
  scene.see_body(pose);
  const Sighting sighting(scene.tables, scene.surface, scene.projector, scene.tolerance);
  RigidTransform slid = pose;
  slid.translation.y() += 0.01;
  const double outline =
      worse_by(scene.tables, scene.patches, sighting, scene.points, {0, nullptr}, pose, slid);
  EXPECT_GT(outline, 0.3) << "enough to tell two motions from one";
}

TEST_F(ComparePoses, AsksOnlyThePatchesThatAreGiven) {
  PatchSet none;
  EXPECT_EQ(worse(pose_, shifted({0, 0, 0.004}), &none), 0) << "nothing asked, nothing said";
  PatchSet one;
  for (std::size_t p = 0; p < scene_.patches.count; ++p) one.add(p);
  EXPECT_EQ(worse(pose_, shifted({0, 0, 0.004}), &one), worse(pose_, shifted({0, 0, 0.004})));
}

}  // namespace
}  // namespace pliant

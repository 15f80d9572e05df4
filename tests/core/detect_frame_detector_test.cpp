#include "core/detect/frame_detector.hpp"

#include <gtest/gtest.h>

#include "core/detect/seam.hpp"
#include "tests/core/bumpy_object.hpp"
#include "tests/frame_of.hpp"

namespace pliant {
namespace {

using testing::AlignedBlock;
using testing::small_camera;
using testing::TestCloud;

struct DetectorFixture {
  explicit DetectorFixture(const Intrinsics& c = small_camera(),
                           const ModelView& model = testing::bumpy_model())
      : block(0) {
    Workspace measure;
    surface.lay_out(measure, c);
    detector.lay_out(measure, model, c, DetectSettings());
    block = AlignedBlock(measure.used());
    Workspace workspace(block.span());
    surface.lay_out(workspace, c);
    detector.lay_out(workspace, model, c, DetectSettings());
    EXPECT_FALSE(workspace.exhausted());
    EXPECT_EQ(workspace.used(), measure.used());
    surface.start(c, SensorDescription());
    detector.start(model, c, SensorDescription(), Kernels::automatic);
  }
  void show(const std::vector<std::uint16_t>& picture, const Intrinsics& c = small_camera()) {
    surface.build(test::frame_of(picture, c), {0, 0, c.width, c.height});
  }
  DetectState run(std::int64_t budget = 1000000) {
    int steps = 0;
    while (detector.step(budget) == DetectState::working) EXPECT_LT(++steps, 100000);
    return detector.state();
  }
  AlignedBlock block;
  Surface surface;
  FrameDetector detector;
};

/// The object at a pose before a wall, a ball beside it.
std::vector<std::uint16_t> scene(const RigidTransform& pose, unsigned seed = 1) {
  TestCloud cloud = testing::moved(testing::bumpy_cloud(60000), pose);
  for (int i = 0; i < 20000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 20000, r = std::sqrt(1 - z * z), a = 2.4 * i;
    const Vector3 d(r * std::cos(a), r * std::sin(a), z);
    cloud.positions.push_back(to_point(Vector3(-0.25, 0.1, 0.8) + 0.08 * d));
    cloud.normals.push_back(testing::normal16(d));
  }
  return testing::depth_picture(small_camera(), cloud, 1.2, 0, 0.0012, seed);
}

TEST(FrameDetector, FindsTheObjectFromManySides) {
  DetectorFixture fixture;
  int found = 0;
  constexpr int kViews = 12;
  for (int k = 0; k < kViews; ++k) {
    const RigidTransform pose =
        testing::test_pose(0.55 * k, Vector3(1, 0.3 * k - 1, 0.5), Vector3(0.05, -0.02, 0.75));
    fixture.show(scene(pose, static_cast<unsigned>(k)));
    fixture.detector.begin(fixture.surface);
    if (fixture.run() != DetectState::found) continue;
    ++found;
    const Detection& d = fixture.detector.best();
    EXPECT_LT(testing::degrees_between(d.pose.rotation, pose.rotation), 5) << k;
    EXPECT_LT((d.pose * testing::bumpy_model().centre() - pose * testing::bumpy_model().centre()).norm(),
              0.01)
        << k;
    EXPECT_GT(d.score, 0.2);
  }
  EXPECT_GE(found, kViews - 1);
}

TEST(FrameDetector, SaysNothingWithoutTheObject) {
  DetectorFixture fixture;
  fixture.show(scene({Matrix3::Identity(), Vector3(0, 0, -5)}));  // behind the camera
  fixture.detector.begin(fixture.surface);
  EXPECT_EQ(fixture.run(), DetectState::nothing);
}

TEST(FrameDetector, ABallOfTheObjectsSizeIsNotTheObject) {
  DetectorFixture fixture;
  for (int k = 0; k < 8; ++k) {
    TestCloud ball;
    const double radius = 0.08 + 0.006 * k;  // the object is 0.07 to 0.16 m in radius
    for (int i = 0; i < 60000; ++i) {
      const double z = 1 - 2 * (i + 0.5) / 60000, r = std::sqrt(1 - z * z), a = 2.4 * i;
      const Vector3 d(r * std::cos(a), r * std::sin(a), z);
      ball.positions.push_back(to_point(Vector3(0.05, -0.02, 0.75) + radius * d));
      ball.normals.push_back(testing::normal16(d));
    }
    fixture.show(testing::depth_picture(small_camera(), ball, 1.2, 1, 0.0012, static_cast<unsigned>(k)));
    fixture.detector.begin(fixture.surface);
    EXPECT_EQ(fixture.run(), DetectState::nothing) << radius;
  }
}

TEST(FrameDetector, SaysNothingOfEmptyAndNoisyPictures) {
  DetectorFixture fixture;
  std::vector<std::uint16_t> picture(320 * 240, 0);
  fixture.show(picture);
  fixture.detector.begin(fixture.surface);
  EXPECT_EQ(fixture.run(), DetectState::nothing);
  std::mt19937 random(3);
  for (std::uint16_t& d : picture) d = static_cast<std::uint16_t>(400 + random() % 3000);
  fixture.show(picture);
  fixture.detector.begin(fixture.surface);
  EXPECT_EQ(fixture.run(), DetectState::nothing);
  std::fill(picture.begin(), picture.end(), std::uint16_t{1000});
  fixture.show(picture);
  fixture.detector.begin(fixture.surface);
  EXPECT_EQ(fixture.run(), DetectState::nothing);
}

TEST(FrameDetector, SlicesDoNotDependOnTheSurfaceNorOnTheirSize) {
  const RigidTransform pose = testing::test_pose(1.1, Vector3(0.2, 1, 0.1), Vector3(0.02, 0.01, 0.7));
  DetectorFixture whole, sliced;
  whole.show(scene(pose));
  whole.detector.begin(whole.surface);
  ASSERT_EQ(whole.run(), DetectState::found);
  sliced.show(scene(pose));
  sliced.detector.begin(sliced.surface);
  sliced.show(std::vector<std::uint16_t>(320 * 240, 0));  // the frame is gone
  ASSERT_EQ(sliced.run(1), DetectState::found);
  EXPECT_EQ(whole.detector.best().pose.rotation, sliced.detector.best().pose.rotation);
  EXPECT_EQ(whole.detector.best().pose.translation, sliced.detector.best().pose.translation);
}

TEST(FrameDetector, AHintIsTriedFirstAndAWrongOneDoesNoHarm) {
  const RigidTransform pose = testing::test_pose(1.1, Vector3(0.2, 1, 0.1), Vector3(0.02, 0.01, 0.7));
  DetectorFixture fixture;
  fixture.show(scene(pose));
  RigidTransform hint = pose;
  hint.translation += Vector3(0.004, -0.003, 0.005);
  fixture.detector.begin(fixture.surface, hint, 0.1);
  ASSERT_EQ(fixture.run(), DetectState::found);
  EXPECT_LT(testing::degrees_between(fixture.detector.best().pose.rotation, pose.rotation), 3);
  hint.translation += Vector3(1, 1, 1);
  fixture.detector.begin(fixture.surface, hint, 0.1);
  ASSERT_EQ(fixture.run(), DetectState::found);
  EXPECT_LT(testing::degrees_between(fixture.detector.best().pose.rotation, pose.rotation), 3);
}

TEST(FrameDetector, WorksOnPicturesOfOtherSizes) {
  for (const int factor : {2, 4}) {
    Intrinsics c = small_camera();
    c.width *= factor;
    c.height *= factor;
    c.fx *= factor;
    c.fy *= factor;
    c.cx *= factor;
    c.cy *= factor;
    const RigidTransform pose = testing::test_pose(1.1, Vector3(0.2, 1, 0.1), Vector3(0.02, 0.01, 0.7));
    const TestCloud cloud = testing::moved(testing::bumpy_cloud(60000), pose);
    DetectorFixture fixture(c);
    fixture.show(testing::depth_picture(c, cloud, 1.2, factor, 0.0012), c);
    fixture.detector.begin(fixture.surface);
    ASSERT_EQ(fixture.run(), DetectState::found) << factor;
    EXPECT_LT(testing::degrees_between(fixture.detector.best().pose.rotation, pose.rotation), 3);
  }
}

TEST(Seam, TellsAnObjectInTheOpenFromOneBuriedInAWall) {
  const RigidTransform pose = testing::test_pose(1.1, Vector3(0.2, 1, 0.1), Vector3(0.02, 0.01, 0.7));
  DetectorFixture fixture;
  fixture.show(scene(pose));
  DepthSnapshot snapshot;
  AlignedBlock block(1 << 20);
  Workspace workspace(block.span());
  snapshot.lay_out(workspace, small_camera());
  snapshot.start(small_camera(), SensorDescription());
  snapshot.take(fixture.surface);
  snapshot.compute_normals(0, snapshot.lattice_height(), 0.01);
  EXPECT_LT(seam_evidence(testing::bumpy_model(), snapshot, pose, 600, 0.004).share(), 0.1);
  // As deep in the wall as its front is flush with it.
  RigidTransform buried = pose;
  buried.translation = Vector3(0.1, -0.1, 1.2 + 0.075);
  const SeamEvidence seam = seam_evidence(testing::bumpy_model(), snapshot, buried, 600, 0.01);
  EXPECT_GT(seam.ring, 5);
  EXPECT_GT(seam.share(), 0.3);
}

}  // namespace
}  // namespace pliant

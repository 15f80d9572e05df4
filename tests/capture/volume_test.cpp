// The distance volume and the fusion of views.
#include <gtest/gtest.h>

#include <cstring>

#include "core/capture/integrate.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "tests/capture/capture_run.hpp"
#include "tests/capture/other_objects.hpp"
#include "tests/capture/scene.hpp"

namespace pliant::test {
namespace {

/// A volume half a metre before the camera, its axes the camera's.
class Volume : public testing::Test {
 protected:
  Volume() {
    settings_.size = 0.2;
    plan_ = volume_plan(settings_, {});
    const auto lay_out = [&](Workspace& workspace) {
      surface_.lay_out(workspace, camera_);
      volume_.lay_out(workspace, plan_);
      fuser_.lay_out(workspace, camera_);
      depth_ = workspace.take<std::uint16_t>(320 * 240);
      facing_ = workspace.take<std::uint8_t>(320 * 240);
      taken_ = workspace.take<std::uint8_t>(160 * 120);
    };
    Workspace measuring;
    lay_out(measuring);
    block_ = block_of(measuring.used());
    Workspace workspace({block_.get(), measuring.used()});
    lay_out(workspace);
    surface_.start(camera_, {});
    projector_.start(camera_);
    fuser_.start(projector_);
    volume_.clear();
    pose_.translation = Vector3(0, 0, 0.5);
  }
  void fuse(const DepthFrame& frame, bool object = true) {
    surface_.build(frame, {0, 0, 320, 240});
    std::fill(taken_.begin(), taken_.end(), object ? std::uint8_t{1} : std::uint8_t{0});
    ViewPicture picture{{0, 0, 320, 240}, depth_, facing_};
    take_picture(surface_, {taken_, 160}, surface_.pixel_span(0.006).span, picture);
    fuser_.fuse({picture, pose_}, surface_, volume_);
  }
  static IntPoint at(double x, double y, double z) {
    return {static_cast<std::int32_t>(x * kUnitsPerMetre), static_cast<std::int32_t>(y * kUnitsPerMetre),
            static_cast<std::int32_t>(z * kUnitsPerMetre)};
  }

  Intrinsics camera_ = small_camera();
  CaptureSettings settings_;
  VolumePlan plan_;
  Block block_;
  Surface surface_;
  Projector projector_;
  DistanceVolume volume_;
  ViewFuser fuser_;
  std::span<std::uint16_t> depth_;
  std::span<std::uint8_t> facing_, taken_;
  RigidTransform pose_;
};

TEST_F(Volume, TellsTheDistanceOfASlantedPlaneAlongItsNormal) {
  const Vector3 normal = Vector3(0.3, -0.2, -0.93).normalized();
  fuse(Picture([&](const Vector3& ray) {
         return plane_depth(ray, normal, normal.dot(Vector3(0, 0, 0.5)));
       }).frame());
  double worst = 0, worst_direction = 1;
  for (const double off : {-0.003, 0.0, 0.003})
    for (double x = -0.03; x <= 0.031; x += 0.01)
      for (double y = -0.03; y <= 0.031; y += 0.01) {
        const double z = -(normal.x() * x + normal.y() * y) / normal.z();
        const Vector3 p = Vector3(x, y, z) + off * normal;
        std::int32_t distance = 0;
        IntPoint gradient;
        ASSERT_TRUE(volume_.sample(at(p.x(), p.y(), p.z()), distance, gradient))
            << x << " " << y << " " << off;
        worst = std::max(worst, std::fabs(distance / 256e3 - off));
        const double cosine = Vector3(gradient.x, gradient.y, gradient.z).dot(normal) / 16384;
        worst_direction = std::min(worst_direction, cosine);
      }
  EXPECT_LT(worst, 0.0005);          // a picture's millimetres, smoothed
  EXPECT_GT(worst_direction, 0.94);  // 20°: one picture in whole millimetres, over a voxel of two
}

TEST_F(Volume, KnowsWhatWasNeverSeenAndWhatWasSeenThrough) {
  const auto wall = [](const Vector3&) { return 0.5; };
  fuse(Picture(wall).frame());
  std::int32_t distance = 0;
  EXPECT_EQ(volume_.place(at(0, 0, 0), distance), Place::surface);
  EXPECT_LT(std::abs(distance), 256);
  EXPECT_EQ(volume_.place(at(0, 0, 0.05), distance), Place::unknown);
  EXPECT_EQ(volume_.place(at(0, 0, -0.012), distance), Place::free);
  EXPECT_EQ(volume_.place(at(0, 0, -0.07), distance), Place::unknown) << "one look is not enough for a block";
  for (int i = 0; i < 5; ++i) fuse(Picture(wall).frame());
  EXPECT_EQ(volume_.place(at(0, 0, -0.07), distance), Place::free);
}

TEST_F(Volume, ForgetsASurfaceThatIsSeenThroughLater) {
  const auto wall = [](const Vector3&) { return 0.5; };
  fuse(Picture(wall).frame());
  std::int32_t distance = 0;
  ASSERT_EQ(volume_.place(at(0, 0, 0), distance), Place::surface);
  for (int i = 0; i < 400; ++i) fuse(Picture([](const Vector3&) { return 0.7; }).frame(), false);
  EXPECT_GT(volume_.at(plan_.cells / 2, plan_.cells / 2, plan_.cells / 2).distance, 4 * 16 * 16);
}

TEST_F(Volume, TheMeanOfManyViewsIsExactToAFractionOfTheirUnit) {
  // Readings of 500 and 501 mm in turn: the surface lies between.
  for (int i = 0; i < 40; ++i)
    fuse(Picture([&](const Vector3&) { return i % 2 == 0 ? 0.5 : 0.501; }).frame());
  std::int32_t distance = 0;
  IntPoint gradient;
  ASSERT_TRUE(volume_.sample(at(0, 0, 0), distance, gradient));
  EXPECT_NEAR(distance / 256.0, 0.5, 0.1);  // millimetres
}

TEST(CapturedSpacing, ATabletopObjectGetsAllPatchesThatTheWarpCanHave) {
  // With fewer, a limb of it is one patch, and too few points to count as a part that moves.
  ModelBuildSettings settings;
  settings.wound_outward = true;
  settings.spacing = captured_spacing(ball(), usual_noise({}));
  const Result<BuiltModel> built = build_model(ball(), settings);
  ASSERT_TRUE(built) << built.error().message;
  ModelView view;
  ASSERT_EQ(ModelView::open(built->image, view), ModelFault::none);
  EXPECT_EQ(view.patches().size(), limits::kMaxPatches);
  EXPECT_LT(view.size(), kUsualPoints * 3 / 2);
}

TEST(CapturedSpacing, FollowsTheSensorWhereTheObjectIsLargeOrSmall) {
  const double sigma = usual_noise({});
  const auto spacing_of = [&](double scale) {
    Geometry object = ball();
    for (Point3f& p : object.vertices)
      p = {static_cast<float>(scale) * p.x, static_cast<float>(scale) * p.y, static_cast<float>(scale) * p.z};
    return captured_spacing(object, sigma);
  };
  EXPECT_DOUBLE_EQ(spacing_of(4), 4 * sigma);
  EXPECT_DOUBLE_EQ(spacing_of(0.6), kVoxelSigmas * sigma) << "the surface is not known finer";
  EXPECT_LT(spacing_of(0.2), kVoxelSigmas * sigma) << "detection needs its keypoints";
}

}  // namespace
}  // namespace pliant::test

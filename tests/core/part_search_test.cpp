#include "core/track/part_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/track/plane_equations.hpp"
#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::TrackScene;
using synthetic::usual_pose;

constexpr double kLimit = 0.004;

/// Readings of all points of every patch, all round the body.
void tell_everything(const TrackScene& scene, PatchWarp& warp) {
  for (std::size_t p = 0; p < scene.patches.count; ++p) warp.moments[p] = PlaneMoments();
  for (std::size_t i = 0; i < scene.tables.size; ++i) {
    const std::size_t p = scene.patches.patch_of[i];
    const FixedPose pose(warp.pose[p], scene.tables.centre);
    const ModelTables& t = scene.tables;
    const Vector3 c = warp.pose[p] * scene.patches.centres[p] * kUnitsPerMetre;
    add_plane_row(warp.moments[p], pose.point(t.x[i], t.y[i], t.z[i]),
                  pose.direction(t.nx[i], t.ny[i], t.nz[i]), 0, 256,
                  {static_cast<std::int32_t>(c.x()), static_cast<std::int32_t>(c.y()),
                   static_cast<std::int32_t>(c.z())});
  }
}

/// A bar along x whose patches the warp has turned about the y axis.
class PartSearch : public synthetic::SharedScene<synthetic::two_part_bar> {
 protected:
  /// Where the bar is at x: the middle line bends by `curvature(x)` radians a metre.
  /// Its readings fit the region, too, from x = `fits_from` on.
  template <typename Curvature>
  bool find(const Curvature& curvature, double fits_from = 1) {
    PatchWarp& warp = *scene().warp;
    warp.reset(usual_pose());
    warp.home.fill(0);
    for (std::size_t p = 0; p < scene().patches.count; ++p)
      warp.fits[p] = scene().patches.centres[p].x() > fits_from;
    for (std::size_t p = 0; p < scene().patches.count; ++p) {
      const double end = scene().patches.centres[p].x();
      Vector3 line = Vector3::Zero();
      double angle = 0;
      constexpr double kStep = 0.0005;
      for (double x = 0; std::fabs(x) < std::fabs(end); x += end > 0 ? kStep : -kStep) {
        const double step = end > 0 ? kStep : -kStep;
        angle += curvature(x) * step;
        line += step * Vector3(std::cos(angle), 0, -std::sin(angle));
      }
      RigidTransform bent;
      bent.rotation = synthetic::turn({0, 1, 0}, angle);
      bent.translation = line - bent.rotation * Vector3(end, 0, 0);
      warp.pose[p] = usual_pose() * bent;
      warp.seen[p] = scene().patches.sizes[p];
    }
    tell_everything(scene(), warp);
    PartSearchSettings settings;
    settings.limit = kLimit;
    return find_rigid_part(scene().patches, warp, 0, usual_pose(), settings, part_);
  }

  RigidPart part_;
};

TEST_F(PartSearch, TakesNoMotionFromWhatItsRegionExplains) {
  const auto joint = [](double x) { return x > 0.05 && x < 0.07 ? 15.0 : 0.0; };
  EXPECT_FALSE(find(joint, 0.04));
  // What shows its motion takes along what does not.
  ASSERT_TRUE(find(joint, 0.12));
  bool any = false;
  for (std::size_t p = 0; p < scene().patches.count; ++p) {
    if (scene().patches.centres[p].x() < 0.12) continue;
    any = true;
    EXPECT_TRUE(part_.patches.has(p));
  }
  EXPECT_TRUE(any);
}

TEST_F(PartSearch, FindsWhatTurnsAtAJoint) {
  // 0.3 radians within 2 cm
  ASSERT_TRUE(find([](double x) { return x > 0.05 && x < 0.07 ? 15.0 : 0.0; }));
  for (std::size_t p = 0; p < scene().patches.count; ++p) {
    const double x = scene().patches.centres[p].x();
    if (x < 0.05 || x > 0.09) {
      EXPECT_EQ(part_.patches.has(p), x > 0.09) << x;
    }
  }
}

TEST_F(PartSearch, APieceOfABendIsNoPart) {
  // the end moves by about 3 cm: several of its pieces would fit a motion of their own
  EXPECT_FALSE(find([](double x) { return x > 0.02 ? 4.0 : 0.0; }));
}

TEST_F(PartSearch, TheStraightEndOfALongBendIsNoPart) {
  for (const double from : {0.02, 0.03})
    for (const double curvature : {8.0, 10.0})
      EXPECT_FALSE(find([&](double x) { return x > from && x < 0.1 ? curvature : 0.0; })) << from;
}

TEST_F(PartSearch, APieceIsBetterThanARegionThatHasLostItsHold) {
  EXPECT_TRUE(find([](double x) { return std::fabs(x) > 0.01 ? 4.0 : 0.0; }));
}

TEST_F(PartSearch, ADentIsNoPartHoweverShallow) {
  const TrackScene body(synthetic::bumpy_body());
  PatchWarp& warp = *body.warp;
  const RigidTransform& pose = usual_pose();
  std::size_t top = 0;
  for (std::size_t p = 0; p < body.patches.count; ++p)
    if (body.patches.centres[p].z() > body.patches.centres[top].z()) top = p;
  for (const double width : {0.02, 0.03, 0.05})
    for (double depth = 0.5; depth < 6; depth += 0.25) {  // inlier limits
      warp.reset(pose);
      warp.home.fill(0);
      for (std::size_t p = 0; p < body.patches.count; ++p) {
        // a surface that falls off as a bell does, each patch turned as the surface is there
        const Vector3 from = body.patches.centres[p] - body.patches.centres[top];
        const double fallen = depth * kLimit * std::exp(-from.squaredNorm() / (2 * width * width));
        const Vector3 slope = fallen / (width * width) * Vector3(from.x(), from.y(), 0);
        const Vector3 axis = Vector3(0, 0, 1).cross(-slope);
        RigidTransform dent;
        if (axis.norm() > 1e-6) dent.rotation = synthetic::turn(axis / axis.norm(), std::atan(axis.norm()));
        const Vector3& centre = body.patches.centres[p];
        dent.translation = centre - dent.rotation * centre - Vector3(0, 0, fallen);
        warp.pose[p] = pose * dent;
        warp.seen[p] = body.patches.sizes[p];
      }
      tell_everything(body, warp);
      PartSearchSettings settings;
      settings.limit = kLimit;
      EXPECT_FALSE(find_rigid_part(body.patches, warp, 0, pose, settings, part_)) << width << " " << depth;
    }
}

TEST_F(PartSearch, FindsNothingWhereNothingMoved) {
  EXPECT_FALSE(find([](double) { return 0.0; }));
}

}  // namespace
}  // namespace pliant

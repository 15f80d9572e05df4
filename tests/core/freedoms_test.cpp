#include "core/track/freedoms.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "core/track/plane_equations.hpp"
#include "tests/core/synthetic.hpp"

namespace pliant {
namespace {

/// Patches of a centimetre, six by eight, on a surface that is given by the normal at each place of it, and
/// the place.
class Freedoms : public ::testing::Test {
 protected:
  struct Spot {
    Vector3 at, normal;
  };
  bool told(const std::function<Spot(double, double)>& surface, int rows = 20) {
    *warp_ = PatchWarp();
    PatchSet set;
    patches_->radius = 0.006;
    patches_->count = 0;
    const RigidTransform pose = synthetic::pose_at({0.1, 0, 0.6}, {1, 2, 0.3}, 0.5);
    for (int across = -3; across < 3; ++across)
      for (int along = -4; along < 4; ++along) {
        const Spot spot = surface(0.01 * across, 0.01 * along);
        const std::size_t p = patches_->count++;
        set.add(p);
        patches_->centres[p] = spot.at;
        patches_->sizes[p] = 20;
        warp_->pose[p] = pose;
        const Vector3 at = pose * spot.at * kUnitsPerMetre, n = pose.rotation * spot.normal * 16384;
        const IntPoint centre{static_cast<std::int32_t>(at.x()), static_cast<std::int32_t>(at.y()),
                              static_cast<std::int32_t>(at.z())};
        for (int row = 0; row < rows; ++row) {
          IntPoint beside = centre;
          beside.x += (row % 5 - 2) * 32;
          beside.y += (row / 5 - 2) * 32;
          add_plane_row(warp_->moments[p], beside,
                        {static_cast<std::int32_t>(n.x()), static_cast<std::int32_t>(n.y()),
                         static_cast<std::int32_t>(n.z())},
                        0, 256, centre);
        }
      }
    return tells_its_motion(*patches_, *warp_, set, pose);
  }
  /// Round about the y axis and, with another radius, about the x axis: 0 is flat.
  static Spot round(double x, double y, double about_y, double about_x) {
    const double a = about_y > 0 ? x / about_y : 0, b = about_x > 0 ? y / about_x : 0;
    const double across = about_y > 0 ? about_y * std::sin(a) : x,
                 along = about_x > 0 ? about_x * std::sin(b) : y;
    const double deep =
        (about_y > 0 ? about_y * (1 - std::cos(a)) : 0) + (about_x > 0 ? about_x * (1 - std::cos(b)) : 0);
    return {{across, along, deep},
            Vector3(std::sin(a), std::sin(b), -std::cos(a) * std::cos(b)).normalized()};
  }

 private:
  std::unique_ptr<PatchTables> patches_ = std::make_unique<PatchTables>();
  std::unique_ptr<PatchWarp> warp_ = std::make_unique<PatchWarp>();
};

TEST_F(Freedoms, APlateSlidesUnnoticed) {
  EXPECT_FALSE(told([](double x, double y) { return round(x, y, 0, 0); }));
}

TEST_F(Freedoms, TheWallOfADentSlidesUnnoticed) {
  for (const double radius : {0.08, 0.1, 0.2})
    EXPECT_FALSE(told([&](double x, double y) { return round(x, y, radius, 2 * radius); })) << radius;
}

TEST_F(Freedoms, ALimbMayTurnAndSlideAlongItself) {
  for (const double radius : {0.01, 0.015, 0.02})
    EXPECT_TRUE(told([&](double x, double y) { return round(x, y, radius, 0); })) << radius;
}

TEST_F(Freedoms, AnEdgeTellsWhenItIsSharp) {
  const auto edge = [](double degrees) {
    return [degrees](double x, double y) {
      const double a = x < 0 ? 0 : degrees * M_PI / 180;
      return Spot{{x * std::cos(a), y, x * std::sin(a)}, {std::sin(a), 0, -std::cos(a)}};
    };
  };
  EXPECT_FALSE(told(edge(5)));
  EXPECT_TRUE(told(edge(60)));
}

TEST_F(Freedoms, WithoutReadingsNothingIsTold) {
  EXPECT_FALSE(told([](double x, double y) { return round(x, y, 0.015, 0); }, 0));
}

}  // namespace
}  // namespace pliant

// The far side of a body, which nobody sees, follows the near one as far as matter would.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/deform/patch_warp.hpp"
#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::Picture;

/// A flat body of 24 × 18 × 3 cm.
Geometry flat_body() {
  Geometry g = synthetic::bumpy_body();
  for (Point3f& p : g.vertices) p.z *= 0.25F;
  return g;
}

/// Its one half bends round, `angle` radians at its end; thickness stays.
Vector3 bent(const Vector3& p, double angle) {
  if (p.x() <= 0 || angle == 0) return p;
  const double radius = 0.12 / angle, a = p.x() / radius;
  return {(radius - p.z()) * std::sin(a), p.y(), radius - (radius - p.z()) * std::cos(a)};
}

class FarSide : public synthetic::SharedScene<flat_body> {
 protected:
  void SetUp() override {
    scene().points.reset();
    scene().place(pose());
    scene().warp->reset(pose());
    scene().patches.start(scene().model);
  }
  static RigidTransform pose() { return synthetic::pose_at({0.01, -0.01, 0.75}, {1, 0.3, 0.1}, 0.35); }

  template <typename Move>
  static void follow(int frames, Move move) {
    for (int frame = 1; frame <= frames; ++frame) {
      Picture picture(scene().camera);
      picture.draw(scene().mesh, pose(), [&](const Vector3& p) { return move(p, frame); });
      picture.wall(1.6);
      picture.shake(0.001, static_cast<unsigned>(frame));
      scene().see(picture);
      scene().warp_now();
    }
  }
  /// Sorted errors of the points that face away and are moved by more than 6 mm, or by less than 1 mm.
  template <typename Move>
  static std::vector<double> errors(bool moved, Move move) {
    const WarpLanes lanes = lanes_of(scene().patches, *scene().warp);
    std::vector<double> out;
    for (std::size_t i = 0; i < scene().tables.size; ++i) {
      const Vector3 rest = scene().rest(i);
      const double way = (move(rest) - rest).norm();
      if (moved ? way < 0.006 : way > 0.001) continue;
      const Vector3 truth = pose() * move(rest);
      if (scene().normal(pose(), i).dot(truth) <= 0) continue;
      out.push_back(scene().off(lanes, i, truth));
    }
    std::sort(out.begin(), out.end());
    return out;
  }
};

TEST_F(FarSide, FollowsABend) {
  double with_ties = 0, without = 0;  // sums of medians
  for (const double sign : {1.0, -1.0}) {
    std::vector<std::vector<double>> found;
    for (const bool tied : {true, false}) {
      SetUp();
      if (!tied) scene().patches.tie_count = 0;
      follow(20, [&](const Vector3& p, int frame) { return bent(p, sign * 0.04 * frame); });
      found.push_back(errors(true, [&](const Vector3& p) { return bent(p, sign * 0.8); }));
      ASSERT_GT(found.back().size(), 100U);
    }
    const std::size_t middle = found[0].size() / 2, late = found[0].size() * 95 / 100;
    EXPECT_LT(found[0][middle], found[1][middle]) << sign;
    EXPECT_LT(found[0][late], found[1][late]) << sign;
    EXPECT_LT(found[0][late], 0.006) << sign;
    with_ties += found[0][middle];
    without += found[1][middle];
  }
  EXPECT_LT(with_ties, 0.85 * without);
}

TEST_F(FarSide, StaysWhereADentIsPressed) {
  const auto dent = [](const Vector3& p, double depth) {
    const double square = (p - Vector3(0.03, 0, p.z())).squaredNorm() / (0.05 * 0.05);
    return square >= 1 || p.z() > 0 ? p : Vector3(p + Vector3(0, 0, depth * (1 - square) * (1 - square)));
  };
  follow(12, [&](const Vector3& p, int frame) { return dent(p, 0.012 * frame / 12); });
  const std::vector<double> still = errors(false, [&](const Vector3& p) { return dent(p, 0.012); });
  ASSERT_GT(still.size(), 100U);
  EXPECT_LT(still[still.size() / 2], 0.0005);
  EXPECT_LT(still.back(), 0.0015) << "an eighth of the dent's depth";
}

}  // namespace
}  // namespace pliant

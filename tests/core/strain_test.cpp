#include "core/deform/strain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/track/joints.hpp"
#include "tests/core/shared_scene.hpp"

namespace pliant {
namespace {

using synthetic::usual_pose;

constexpr double kMaterial = 0.5;

class StrainTest : public synthetic::SharedScene<synthetic::two_part_bar> {
 protected:
  void SetUp() override {
    warp().home.fill(0);
    move_all(usual_pose());
  }
  static PatchWarp& warp() { return *scene().warp; }
  static const PatchTables& patches() { return scene().patches; }

  static void move(std::size_t patch, const RigidTransform& pose) {
    warp().pose[patch] = pose;
    warp().fixed[patch] = FixedPose(pose, scene().tables.centre);
  }
  static void move_all(const RigidTransform& pose) {
    for (std::size_t p = 0; p < patches().count; ++p) move(p, pose);
  }
  /// Every patch keeps its shape; their centres move apart from the model's centre.
  static void stretch(double share) {
    for (std::size_t p = 0; p < patches().count; ++p) {
      RigidTransform pose = usual_pose();
      pose.translation += pose.rotation * (share * (patches().centres[p] - scene().tables.centre));
      move(p, pose);
    }
  }
  static std::vector<double> sorted_strains() {
    const Strain strain = measure_strain(patches(), warp(), kMaterial);
    std::vector<double> all;
    for (std::size_t i = 0; i < scene().tables.size; ++i)
      all.push_back(static_cast<double>(strain_at(patches(), strain, i)));
    std::sort(all.begin(), all.end());
    return all;
  }
  static double most(const std::vector<double>& sorted) {
    return sorted.empty() ? -1 : sorted[sorted.size() - 1];
  }
  /// Edges of borders, of all or of one patch's.
  static double edges(int patch = -1) {
    double sum = 0;
    for (std::size_t k = 0; k < patches().border_count; ++k) {
      const PatchBorder& border = patches().borders[k];
      if (patch < 0 || border.a == patch || border.b == patch) sum += border.edges;
    }
    return sum;
  }
};

TEST_F(StrainTest, IsNoneWhereAllMovesAsOne) {
  EXPECT_LT(most(sorted_strains()), 1e-6);
  const Strain all = measure_strain(patches(), warp(), kMaterial);
  EXPECT_LT(all.energy, 1e-12);
  EXPECT_EQ(all.overstrained, 0);
}

TEST_F(StrainTest, OfAPointIsTheShareByWhichTheSurfaceIsStretched) {
  for (const double share : {0.1, 0.05, -0.1}) {
    stretch(share);
    const std::vector<double> strains = sorted_strains();
    EXPECT_NEAR(strains.front(), std::fabs(share), 1e-6);
    EXPECT_NEAR(strains.back(), std::fabs(share), 1e-6);
  }
}

TEST_F(StrainTest, EnergyIsOneWhereAllIsStretchedToTheLimit) {
  for (const double material : {0.0, 0.5, 1.0}) {
    stretch(strain_limit(material));
    EXPECT_NEAR(measure_strain(patches(), warp(), material).energy, 1, 1e-9) << material;
    stretch(2 * strain_limit(material));
    EXPECT_NEAR(measure_strain(patches(), warp(), material).energy, 4, 1e-9);
  }
}

TEST_F(StrainTest, CountsTheShareThatIsStretchedBeyondTheLimit) {
  constexpr int kMoved = 7;
  double longest = 0, shortest = 1, inverse_squares = 0;
  for (std::size_t k = 0; k < patches().border_count; ++k) {
    const PatchBorder& border = patches().borders[k];
    if (border.a != kMoved && border.b != kMoved) continue;
    longest = std::max(longest, border.length);
    shortest = std::min(shortest, border.length);
    inverse_squares += border.edges / (border.length * border.length);
  }
  const double limit = strain_limit(kMaterial), shift = 1.01 * limit * longest;
  RigidTransform pose = usual_pose();
  pose.translation.y() += shift;
  move(kMoved, pose);
  const Strain strain = measure_strain(patches(), warp(), kMaterial);
  ASSERT_GT(edges(kMoved), 0);
  EXPECT_NEAR(strain.overstrained, edges(kMoved) / edges(), 1e-12);
  EXPECT_NEAR(strain.energy, shift * shift / (limit * limit) * inverse_squares / edges(), 1e-9);
  pose.translation.y() += 0.99 * limit * shortest - shift;
  move(kMoved, pose);
  EXPECT_EQ(measure_strain(patches(), warp(), kMaterial).overstrained, 0);
}

TEST_F(StrainTest, BendingCountsWithoutStretching) {
  // One patch turned about the middle of its only counted border: the others belong to another region.
  const PatchBorder& border = patches().borders[3];
  for (std::size_t p = 0; p < patches().count; ++p) warp().home[p] = 1;
  warp().home[border.a] = warp().home[border.b] = 0;
  const Vector3 hinge = usual_pose() * border.centre;
  const RigidTransform turned{synthetic::turn({1, 0, 0}, bend_limit(kMaterial)), Vector3::Zero()};
  RigidTransform about = turned;
  about.translation = hinge - turned.rotation * hinge;
  move(border.a, about * usual_pose());
  const Strain strain = measure_strain(patches(), warp(), kMaterial);
  double counted = 0;
  for (std::size_t k = 0; k < patches().border_count; ++k)
    if (warp().home[patches().borders[k].a] == warp().home[patches().borders[k].b])
      counted += patches().borders[k].edges;
  // A turn is measured by its sine.
  const double bend = std::sin(bend_limit(kMaterial)) / bend_limit(kMaterial);
  EXPECT_NEAR(strain.energy, bend * bend * border.edges / counted, 1e-9);
  EXPECT_EQ(strain.overstrained, 0);
}

TEST_F(StrainTest, RegionsTurnFreelyAgainstEachOther) {
  RigidTransform bent = usual_pose();
  bent.rotation = synthetic::turn({0, 0, 1}, 0.7) * bent.rotation;
  for (std::size_t p = 0; p < patches().count; ++p) {
    if (patches().centres[p].x() < 0) continue;
    warp().home[p] = 1;
    move(p, bent);
  }
  EXPECT_LT(measure_strain(patches(), warp(), kMaterial).energy, 1e-12);
  warp().home.fill(0);
  EXPECT_GT(measure_strain(patches(), warp(), kMaterial).energy, 1);
}

TEST_F(StrainTest, AJointIsTheMiddleOfTheBorder) {
  for (std::size_t p = 0; p < patches().count; ++p) warp().home[p] = patches().centres[p].x() < 0 ? 0 : 1;
  Vector3 joint;
  ASSERT_TRUE(find_joint(patches(), warp(), 1, 0, joint));
  // The bar's two parts meet at the origin; a border runs through patches' edges.
  EXPECT_LT(joint.norm(), patches().radius);
  Vector3 other;
  ASSERT_TRUE(find_joint(patches(), warp(), 0, 1, other));
  EXPECT_EQ(joint, other) << "from whichever side";
}

TEST_F(StrainTest, ThereIsNoJointWhereRegionsDoNotTouch) {
  for (std::size_t p = 0; p < patches().count; ++p) {
    const double x = patches().centres[p].x();
    warp().home[p] = static_cast<std::int8_t>(x < -0.06 ? 0 : x < 0.06 ? 2 : 1);
  }
  Vector3 joint;
  EXPECT_FALSE(find_joint(patches(), warp(), 1, 0, joint));
  ASSERT_TRUE(find_joint(patches(), warp(), 1, 2, joint));
  EXPECT_NEAR(joint.x(), 0.06, patches().radius);
  EXPECT_FALSE(find_joint(patches(), warp(), 3, 0, joint)) << "a region of no patches";
}

}  // namespace
}  // namespace pliant

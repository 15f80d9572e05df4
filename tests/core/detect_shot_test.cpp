#include "core/detect/shot.hpp"

#include <gtest/gtest.h>

#include "tests/core/bumpy_object.hpp"

namespace pliant {
namespace {

using testing::AlignedBlock;
using testing::TestCloud;

struct Described {
  std::vector<Descriptor> descriptors;
  std::vector<LocalFrame> frames;
  std::vector<bool> good;
  std::vector<float> leans;
};

Described describe(const TestCloud& cloud, double radius, std::size_t count) {
  AlignedBlock block(4 << 20);
  Workspace workspace(block.span());
  PointGrid grid;
  grid.lay_out(workspace, cloud.positions.size());
  EXPECT_TRUE(grid.build(cloud.positions, grid_cell_for_support(radius)));
  ShotDescriber describer;
  describer.lay_out(workspace);
  Described out;
  for (std::size_t i = 0; i < count; ++i) {
    Descriptor d;
    LocalFrame f;
    float lean = 0;
    out.good.push_back(describer.describe(cloud.view(), grid, i, radius, d, f, &lean));
    out.descriptors.push_back(d);
    out.frames.push_back(f);
    out.leans.push_back(lean);
  }
  return out;
}

int dot(const Descriptor& a, const Descriptor& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.bins.size(); ++i) sum += a.bins[i] * b.bins[i];
  return sum;
}

Matrix3 axes(const LocalFrame& f) {
  Matrix3 m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = f.axes[static_cast<std::size_t>(i)] / 16384.0;
  return m;
}

/// A limb: a bent rod of 8 mm radius with a bulge, from which a picture shows only what faces +z.
TestCloud limb(bool all) {
  TestCloud cloud;
  for (int i = 0; i < 120; ++i)
    for (int j = 0; j < 40; ++j) {
      const double along = -0.06 + 0.001 * i, angle = 2 * M_PI * j / 40;
      const double radius = 0.008 + 0.003 * std::exp(-along * along / 0.0004);
      const Vector3 normal(0, std::cos(angle), std::sin(angle));
      if (!all && normal.z() < 0) continue;
      cloud.positions.push_back(to_point(Vector3(along, 8 * along * along, 0) + radius * normal));
      cloud.normals.push_back(testing::normal16(normal));
    }
  return cloud;
}

TEST(Shot, WhatFacesAwayDoesNotCount) {
  // On the front of a limb, a picture and the whole model must tell the same.
  const TestCloud whole = limb(true), front = limb(false);
  AlignedBlock block(8 << 20);
  Workspace workspace(block.span());
  PointGrid grids[2];
  ShotDescriber describer;
  describer.lay_out(workspace);
  for (PointGrid& grid : grids) grid.lay_out(workspace, whole.positions.size());
  ASSERT_TRUE(grids[0].build(whole.positions, 0.02));
  ASSERT_TRUE(grids[1].build(front.positions, 0.02));
  for (int k = -4; k <= 4; ++k) {
    const double along = 0.005 * k;
    const Point3f at = to_point(Vector3(along, 8 * along * along, 0.008));
    Descriptor a, b;
    LocalFrame f, g;
    ASSERT_TRUE(describer.describe_at(whole.view(), grids[0], at, 0.03, a, f));
    ASSERT_TRUE(describer.describe_at(front.view(), grids[1], at, 0.03, b, g));
    EXPECT_GT(dot(a, b), 0.97 * 127 * 127) << k;
    EXPECT_GT(cos_angle(axes(f).transpose() * axes(g)), 0.98) << k;
  }
}

TEST(Shot, TurnsWithTheObject) {
  const TestCloud cloud = testing::bumpy_cloud(2500);
  const RigidTransform pose = testing::test_pose(1.9, Vector3(1, -2, 0.5), Vector3(0.3, -0.2, 0.9));
  const Described here = describe(cloud, 0.045, 400),
                  there = describe(testing::moved(cloud, pose), 0.045, 400);
  for (std::size_t i = 0; i < 400; ++i) {
    ASSERT_TRUE(here.good[i] && there.good[i]);
    EXPECT_GT(dot(here.descriptors[i], there.descriptors[i]), 0.97 * 127 * 127) << i;
    if (here.leans[i] > 0.02F) {
      EXPECT_LT(
          testing::degrees_between(axes(there.frames[i]), axes(here.frames[i]) * pose.rotation.transpose()),
          2.0)
          << i;
    }
  }
}

TEST(Shot, TellsPlacesApart) {
  const Described all = describe(testing::bumpy_cloud(2500), 0.045, 2500);
  int alike = 0;
  for (std::size_t i = 0; i < 2500; i += 50)
    for (std::size_t j = 0; j < 2500; j += 50)
      alike += i != j && dot(all.descriptors[i], all.descriptors[j]) > 0.97 * 127 * 127 ? 1 : 0;
  EXPECT_LT(alike, 245);  // of 2,450 pairs, on an object that is smooth between its lumps
}

TEST(Shot, KeepsItsNumberFormat) {
  const Described all = describe(testing::bumpy_cloud(2500), 0.045, 500);
  for (std::size_t i = 0; i < 500; ++i) {
    for (const std::int8_t b : all.descriptors[i].bins) ASSERT_GE(b, 0);
    EXPECT_NEAR(std::sqrt(dot(all.descriptors[i], all.descriptors[i])), 127, 5);
    EXPECT_LT((axes(all.frames[i]) * axes(all.frames[i]).transpose() - Matrix3::Identity()).norm(), 1e-3);
    EXPECT_NEAR(axes(all.frames[i]).determinant(), 1, 1e-3);
  }
}

TEST(Shot, RefusesWhatFixesNoFrame) {
  TestCloud plane;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j) {
      plane.positions.push_back({0.01F * static_cast<float>(i), 0.01F * static_cast<float>(j), 1});
      plane.normals.push_back({0, 0, -16384, 0});
    }
  const Described flat = describe(plane, 0.05, 900);
  for (std::size_t i = 0; i < 900; ++i) {
    EXPECT_FALSE(flat.good[i]);
    EXPECT_EQ(dot(flat.descriptors[i], flat.descriptors[i]), 0);
  }
  TestCloud few = testing::bumpy_cloud(8);
  EXPECT_FALSE(describe(few, 1.0, 1).good[0]);
  TestCloud heap;
  heap.positions.assign(3000, Point3f{0.5F, 0.5F, 0.5F});
  heap.normals.assign(3000, Normal16{16384, 0, 0, 0});
  EXPECT_FALSE(describe(heap, 0.05, 1).good[0]);
}

TEST(Shot, SupportGrowsWithTheModelAndItsSpacing) {
  EXPECT_DOUBLE_EQ(support_radius_for(0.001, 0.2), 0.06);
  EXPECT_DOUBLE_EQ(support_radius_for(0.02, 0.2), 0.12);
}

}  // namespace
}  // namespace pliant

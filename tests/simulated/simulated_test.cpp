// The simulated sensor as a user of it sees it: frames, and a truth that fits them.
#include "drivers/simulated/simulated.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace pliant {
namespace {

std::uint64_t fingerprint(std::uint64_t hash, const DepthFrame& frame) {
  for (int i = 0; i < frame.width * frame.height; ++i) hash = (hash ^ frame.depth[i]) * 1099511628211U;
  return hash;
}

/// FNV-1a over the depth of all frames.
std::uint64_t fingerprint(const std::string& options) {
  auto source = open_simulated(options);
  if (!source) return 0;
  SourceItem item;
  std::uint64_t hash = 14695981039346656037U;
  for ((*source)->next(0, item); item.event == SourceEvent::frame; (*source)->next(0, item))
    hash = fingerprint(hash, item.frame);
  return hash;
}

class SimulatedObject : public testing::TestWithParam<const char*> {
 protected:
  static std::unique_ptr<SimulatedSource> open(const std::string& more) {
    auto source = open_simulated(std::string(GetParam()) + "?" + more);
    EXPECT_TRUE(source);
    return source ? std::move(*source) : nullptr;
  }
};

TEST_P(SimulatedObject, DeliversTheFramesAskedFor) {
  const auto source = open("frames=40&width=320&height=240");
  ASSERT_NE(source, nullptr);
  EXPECT_EQ(source->frame_count(), 40);
  EXPECT_EQ(source->intrinsics().fx, 285);
  EXPECT_EQ(intrinsics_fault(source->intrinsics()), nullptr);
  EXPECT_EQ(source->truth().number, -1);
  SourceItem item;
  for (int i = 0; i < 40; ++i) {
    source->next(0, item);
    ASSERT_EQ(item.event, SourceEvent::frame);
    EXPECT_EQ(item.frame.number, i);
    EXPECT_EQ(item.frame.utime, std::llround(i * 1e6 / 30));
    EXPECT_EQ(item.frame.width, 320);
    EXPECT_EQ(item.frame.stride, 320);
    EXPECT_EQ(item.frame.height, 240);
    EXPECT_EQ(source->truth().number, i);
    EXPECT_EQ(source->truth().utime, item.frame.utime);
  }
  source->next(0, item);
  EXPECT_EQ(item.event, SourceEvent::end);
  source->close();
  source->next(0, item);
  EXPECT_EQ(item.event, SourceEvent::end);
}

TEST_P(SimulatedObject, SameOptionsGiveTheSameBytes) {
  const std::string options = std::string(GetParam()) + "?frames=3&width=320&height=240";
  const std::uint64_t first = fingerprint(options);
  EXPECT_EQ(fingerprint(options), first);
  EXPECT_NE(fingerprint(options + "&seed=2"), first);
}

TEST_P(SimulatedObject, TruthFitsTheDepth) {
  const auto source = open("noise=none&frames=90");
  const Intrinsics& camera = source->intrinsics();
  SourceItem item;
  for (source->next(0, item); item.event == SourceEvent::frame; source->next(0, item)) {
    if (item.frame.number % 15 != 0) continue;
    const SimulatedTruth& truth = source->truth();
    ASSERT_TRUE(truth.present);
    std::size_t visible = 0;
    std::size_t fits = 0;
    std::size_t floats = 0;
    for (std::size_t i = 0; i < truth.vertices.size(); ++i) {
      const Vector3 p = to_vector(truth.vertices[i]);
      const auto u = static_cast<int>(std::lround(camera.fx * p.x() / p.z() + camera.cx));
      const auto v = static_cast<int>(std::lround(camera.fy * p.y() / p.z() + camera.cy));
      if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) {
        EXPECT_EQ(truth.visible[i], 0);
        continue;
      }
      double nearest = 1e9;  // of the pixels around it
      double closest = 1e9;
      for (int y = std::max(v - 1, 0); y <= std::min(v + 1, camera.height - 1); ++y)
        for (int x = std::max(u - 1, 0); x <= std::min(u + 1, camera.width - 1); ++x) {
          const double seen = item.frame.depth[y * camera.width + x] * 0.001;
          if (seen > 0) nearest = std::min(nearest, seen);
          closest = std::min(closest, std::fabs(seen - p.z()));
        }
      floats += p.z() < nearest - 0.01 ? 1U : 0U;
      visible += truth.visible[i];
      fits += truth.visible[i] != 0 && closest < 0.005 ? 1U : 0U;
    }
    EXPECT_GT(visible, truth.vertices.size() / 5);
    EXPECT_LT(visible, truth.vertices.size() * 6 / 10);
    EXPECT_GT(fits, visible * 96 / 100);
    EXPECT_LT(floats, truth.vertices.size() / 200);
  }
}

TEST_P(SimulatedObject, RigidVerticesFollowTheirPart) {
  const auto source = open("noise=none&frames=120&width=160&height=120");
  SourceItem item;
  for (source->next(0, item); item.event == SourceEvent::frame; source->next(0, item)) {
    const SimulatedTruth& truth = source->truth();
    for (std::size_t i = 0; i < truth.vertices.size(); ++i) {
      if (truth.vertex_part[i] < 0) continue;
      const RigidTransform& part = truth.parts[static_cast<std::size_t>(truth.vertex_part[i])];
      ASSERT_LT((part * to_vector(source->mesh().vertices[i]) - to_vector(truth.vertices[i])).norm(), 1e-6);
    }
    for (const RigidTransform& part : truth.parts) {
      ASSERT_LT((part.rotation * part.rotation.transpose() - Matrix3::Identity()).norm(), 1e-9);
      ASSERT_GT(part.rotation.determinant(), 0);
    }
  }
}

TEST_P(SimulatedObject, StandsStillThenMovesAsAHandWouldMoveItAndComesRound) {
  const auto source = open("noise=none&frames=320&width=160&height=120");
  std::vector<Point3f> first, last;
  std::vector<RigidTransform> parts;
  double fastest = 0, turned = 0, farthest = 0;
  SourceItem item;
  for (source->next(0, item); item.event == SourceEvent::frame; source->next(0, item)) {
    const SimulatedTruth& truth = source->truth();
    double moved = 0;
    double away = 0;
    for (std::size_t i = 0; i < last.size(); ++i) {
      moved = std::max(moved, (to_vector(truth.vertices[i]) - to_vector(last[i])).norm());
      away = std::max(away, (to_vector(truth.vertices[i]) - to_vector(first[i])).norm());
    }
    for (std::size_t k = 0; k < parts.size(); ++k)
      turned = std::max(
          turned, std::acos(std::clamp(cos_angle(parts[k].rotation.transpose() * truth.parts[k].rotation),
                                       -1.0, 1.0)));
    fastest = std::max(fastest, moved);
    farthest = std::max(farthest, away);
    if (truth.number <= 15 || truth.number == 300) {
      EXPECT_EQ(away, 0) << truth.number;
    }
    if (first.empty()) first.assign(truth.vertices.begin(), truth.vertices.end());
    last.assign(truth.vertices.begin(), truth.vertices.end());
    parts.assign(truth.parts.begin(), truth.parts.end());
  }
  EXPECT_LE(fastest, 0.0102);  // metres a frame
  EXPECT_LE(turned * 57.2958, 2.05);
  EXPECT_GE(farthest, 0.05);
}

INSTANTIATE_TEST_SUITE_P(All, SimulatedObject, testing::Values("cushion", "figure", "box"));

TEST(Simulated, TheCushionIsDentedAndComesBack) {
  auto source = open_simulated("cushion?noise=none&frames=200&width=160&height=120");
  ASSERT_TRUE(source);
  const Geometry& mesh = (*source)->mesh();
  double deepest = 0;
  double at_rest = 0;
  SourceItem item;
  for ((*source)->next(0, item); item.event == SourceEvent::frame; (*source)->next(0, item)) {
    const SimulatedTruth& truth = (*source)->truth();
    double off = 0;
    for (std::size_t i = 0; i < truth.vertices.size(); ++i)
      off =
          std::max(off, (truth.parts[0] * to_vector(mesh.vertices[i]) - to_vector(truth.vertices[i])).norm());
    deepest = std::max(deepest, off);
    if (truth.number == 190) at_rest = off;
  }
  EXPECT_NEAR(deepest, 0.035, 0.001);
  EXPECT_LT(at_rest, 1e-6);
  const auto parts = (*source)->truth().vertex_part;
  EXPECT_GT(std::count(parts.begin(), parts.end(), -1), std::ssize(parts) / 20);
  EXPECT_GT(std::count(parts.begin(), parts.end(), 0), std::ssize(parts) / 2);
}

TEST(Simulated, TheFigureBendsAtItsJoints) {
  auto source = open_simulated("figure?noise=none&frames=300&width=160&height=120");
  ASSERT_TRUE(source);
  double waist = 0;
  double elbow = 0;
  SourceItem item;
  for ((*source)->next(0, item); item.event == SourceEvent::frame; (*source)->next(0, item)) {
    const auto parts = (*source)->truth().parts;
    ASSERT_EQ(parts.size(), 3U);
    const auto angle = [](const RigidTransform& a, const RigidTransform& b) {
      return 57.2958 * std::acos(std::clamp(cos_angle(a.rotation.transpose() * b.rotation), -1.0, 1.0));
    };
    waist = std::max(waist, angle(parts[0], parts[1]));
    elbow = std::max(elbow, angle(parts[1], parts[2]));
  }
  EXPECT_GT(waist, 15);
  EXPECT_GT(elbow, 45);
}

TEST(Simulated, TheBoxLeavesAndComesBackAndIsHiddenInPart) {
  auto source = open_simulated("box?noise=none&frames=300&width=320&height=240");
  ASSERT_TRUE(source);
  std::vector<int> seen;
  std::vector<bool> present;
  SourceItem item;
  for ((*source)->next(0, item); item.event == SourceEvent::frame; (*source)->next(0, item)) {
    const SimulatedTruth& truth = (*source)->truth();
    seen.push_back(static_cast<int>(std::count(truth.visible.begin(), truth.visible.end(), 1)));
    present.push_back(truth.present);
  }
  EXPECT_TRUE(present.front());
  EXPECT_TRUE(present.back());
  EXPECT_GE(std::count(present.begin(), present.end(), false), 15);
  EXPECT_EQ(seen[208], 0);
  const int hidden = *std::min_element(seen.begin() + 15, seen.begin() + 120);
  EXPECT_LT(hidden, seen[0] * 3 / 4);  // the hand covers some
  EXPECT_GT(hidden, seen[0] / 4);
}

TEST(Simulated, TheBytesAreTheSameOnEveryPlatform) {
  // To be renewed whenever scenes or sensor model change on purpose; must not depend on compiler or machine.
  EXPECT_EQ(fingerprint("cushion?frames=20&width=320&height=240"), 0x38daaa1d453acef6U);
  EXPECT_EQ(fingerprint("figure?frames=20&width=320&height=240"), 0x81a2b6d664bba45eU);
  EXPECT_EQ(fingerprint("box?frames=20&width=320&height=240"), 0x5164a44cbb6556aaU);
}

TEST(Simulated, BadOptionsAreRefused) {
  const auto source = open_simulated("sphere");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().kind, ErrorKind::bad_input);
}

}  // namespace
}  // namespace pliant

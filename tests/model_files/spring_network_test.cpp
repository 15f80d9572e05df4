#include "drivers/model_files/spring_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "tests/model_files/built.hpp"
#include "tests/model_files/shapes.hpp"

namespace pliant {
namespace {

using namespace testing;

TEST(SpringNetwork, PatchesCoverTheSurfaceInEvenConnectedPieces) {
  const Made made = make(shapes::cushion_with_knob());
  const ModelView& model = made.view();
  const std::size_t patches = model.patches().size();
  ASSERT_EQ(patches, std::min(limits::kMaxPatches, model.size() / 24));
  const std::size_t mean = model.size() / patches;
  for (std::size_t p = 0; p < patches; ++p) {
    EXPECT_GT(model.patches()[p].points, mean / 4);
    EXPECT_LT(model.patches()[p].points, mean * 3);
    EXPECT_EQ(model.patch_of()[p], p);  // its seed is its own
  }
  // From every point a way along the graph leads to the seed within the patch.
  std::vector<bool> reached(model.size(), false);
  std::vector<std::size_t> stack;
  for (std::size_t p = 0; p < patches; ++p) {
    stack.push_back(p);
    reached[p] = true;
  }
  while (!stack.empty()) {
    const std::size_t i = stack.back();
    stack.pop_back();
    for (const std::uint16_t n : model.neighbours(i)) {
      if (n == kNoNeighbour || reached[n] || model.patch_of()[n] != model.patch_of()[i]) continue;
      reached[n] = true;
      stack.push_back(n);
    }
  }
  EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 0);
}

TEST(SpringNetwork, LinksJoinThePatchesThatEdgesOfTheGraphJoin) {
  const Made made = make(shapes::torus(0.1, 0.03, 40));
  const ModelView& model = made.view();
  std::set<std::pair<int, int>> joined;
  std::size_t edges = 0;
  for (std::size_t i = 0; i < model.size(); ++i)
    for (const std::uint16_t n : model.neighbours(i)) {
      if (n == kNoNeighbour || model.patch_of()[n] == model.patch_of()[i]) continue;
      joined.insert(std::minmax<int>(model.patch_of()[i], model.patch_of()[n]));
      ++edges;
    }
  ASSERT_EQ(model.surface_links().size(), joined.size());
  const double wide = 2 * model.patch_radius();
  for (const SurfaceLink& link : model.surface_links()) {
    EXPECT_TRUE(joined.contains({link.a, link.b}));
    const Vector3 a = to_vector(model.patches()[link.a].centre),
                  b = to_vector(model.patches()[link.b].centre);
    EXPECT_DOUBLE_EQ(link.length, (a - b).norm());
    EXPECT_LT((to_vector(link.centre) - 0.5 * (a + b)).norm(), wide);
    edges -= link.edges;
  }
  EXPECT_EQ(edges, 0U);
}

TEST(SpringNetwork, EveryPointMovesWithThePatchesAroundIt) {
  const Made made = make(shapes::torus(0.1, 0.03, 40));
  const ModelView& model = made.view();
  std::size_t led_by_own = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const PointBlend& blend = model.blends()[i];
    Vector3 sum = Vector3::Zero();
    for (std::size_t j = 0; j < 4; ++j)
      sum += blend.weight[j] * to_vector(model.patches()[blend.patch[j]].centre) / 128;
    EXPECT_LT((sum - to_vector(model.positions()[i])).norm(), 2 * model.patch_radius());
    led_by_own += blend.patch[0] == model.patch_of()[i] ? 1U : 0U;
  }
  EXPECT_GT(led_by_own, model.size() * 3 / 4);
}

TEST(SpringNetwork, TheStrongestLinksAreKeptInTheirOrder) {
  std::vector<BodyLink> links;
  for (const auto& [a, b, looks] : {std::array{0, 1, 5}, {0, 2, 3}, {1, 2, 3}, {1, 4, 9}, {2, 3, 2}}) {
    BodyLink link;
    link.a = static_cast<std::uint8_t>(a);
    link.b = static_cast<std::uint8_t>(b);
    link.looks = static_cast<std::uint32_t>(looks);
    links.push_back(link);
  }
  const auto kept = [&](std::size_t most) {
    std::vector<BodyLink> left = links;
    keep_strongest(left, most, &BodyLink::looks);
    std::vector<std::pair<int, int>> ends;
    for (const BodyLink& link : left) ends.emplace_back(link.a, link.b);
    return ends;
  };
  using Ends = std::vector<std::pair<int, int>>;
  EXPECT_EQ(kept(5), (Ends{{0, 1}, {0, 2}, {1, 2}, {1, 4}, {2, 3}}));
  EXPECT_EQ(kept(3), (Ends{{0, 1}, {0, 2}, {1, 4}}));  // of equals the first
  EXPECT_EQ(kept(1), (Ends{{1, 4}}));
}

TEST(BodyLinks, SpanAPlateFromSideToSide) {
  const Vector3 size(0.2, 0.15, 0.03);
  const Made made = make(shapes::box(size.x(), size.y(), size.z()));
  const ModelView& model = made.view();
  ASSERT_GT(model.body_links().size(), 80U);
  std::vector<bool> tied(model.patches().size(), false);
  for (const BodyLink& link : model.body_links()) {
    // Straight across in one of the three directions, but where a patch goes round an edge.
    const Vector3 off = (size.array() - link.length).abs();
    if (off.minCoeff() < 0.001) tied[link.a] = tied[link.b] = true;
    EXPECT_GE(link.length, 0.4 * size.z());
    // Its middle is inside.
    EXPECT_GT(to_vector(link.middle).minCoeff(), 0);
    EXPECT_GT((size - to_vector(link.middle)).minCoeff(), 0);
  }
  for (std::size_t p = 0; p < model.patches().size(); ++p) {
    const Vector3 at = to_vector(model.patches()[p].centre);
    if (std::min(at.z(), size.z() - at.z()) > 1e-4) continue;
    EXPECT_TRUE(tied[p]) << p;  // all of it on one side
  }
}

TEST(BodyLinks, AreAsLongAsTheBodyIsThick) {
  const Made ball = make(shapes::sphere(0.1, 50));
  ASSERT_GT(ball.view().body_links().size(), 50U);
  for (const BodyLink& link : ball.view().body_links()) EXPECT_NEAR(link.length, 0.2, 0.02);
  // Across the tube, not across the hole.
  const Made ring = make(shapes::torus(0.1, 0.03, 40));
  ASSERT_GT(ring.view().body_links().size(), 50U);
  for (const BodyLink& link : ring.view().body_links()) EXPECT_NEAR(link.length, 0.06, 0.01);
}

TEST(BodyLinks, AreNoneWhereThereIsNoBody) {
  EXPECT_TRUE(make(shapes::plane(0.2, 0.15, 60)).view().body_links().empty());
  const double half_turn = std::numbers::pi;
  const Geometry bowl = shapes::patch(120, 60, [&](double s, double t) {
    const double around = 2 * half_turn * s, up = 0.5 * half_turn * (t - 1);
    return Vector3(0.1 * std::cos(up) * std::cos(around), 0.1 * std::cos(up) * std::sin(around),
                   0.1 * std::sin(up));
  });
  EXPECT_TRUE(make(bowl).view().body_links().empty());
}

TEST(BodyLinks, AreThereForAScanWithSomeHoles) {
  Geometry ball = shapes::sphere(0.1, 60);
  std::erase_if(ball.triangles, [&](const auto& t) { return ball.vertices[t[0]].z < -0.097F; });
  const Made made = make(ball);
  ASSERT_FALSE(made.built.closed_surface);
  EXPECT_GT(made.view().body_links().size(), 50U);
}

TEST(SpringNetwork, KeepsTheMaterial) {
  ModelBuildSettings settings;
  EXPECT_EQ(make(shapes::box(0.1, 0.1, 0.2), settings).view().material(), 0.5);
  settings.material = 0.125;
  EXPECT_EQ(make(shapes::box(0.1, 0.1, 0.2), settings).view().material(), 0.125);
  for (const double wrong : {-0.1, 1.1, std::nan("")}) {
    settings.material = wrong;
    const Result<BuiltModel> built = build_model(shapes::box(0.1, 0.1, 0.2), settings);
    ASSERT_FALSE(built);
    EXPECT_TRUE(mentions(built.error().message, "material"));
  }
}

}  // namespace
}  // namespace pliant

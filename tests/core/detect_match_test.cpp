#include <gtest/gtest.h>

#include <random>

#include "core/detect/descriptor_match.hpp"
#include "core/detect/grouping.hpp"
#include "core/simd/cpu.hpp"
#include "tests/core/bumpy_object.hpp"

namespace pliant {
namespace {

using testing::AlignedBlock;

/// Random descriptors of norm 127, as sparse as real ones; the first two are extreme.
std::vector<Descriptor> random_descriptors(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> spread(0, 1);
  std::vector<Descriptor> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    double values[kDescriptorSize], square = 0;
    for (double& v : values) {
      v = spread(random) < 0.3 ? spread(random) : 0;
      square += v * v;
    }
    for (std::size_t k = 0; k < kDescriptorSize; ++k)
      out[i].bins[k] = static_cast<std::int8_t>(values[k] * 127 / std::sqrt(square) + 0.5);
  }
  if (count > 1) {
    out[0].bins.fill(7);  // all bins alike: the longest carry chains
    out[1].bins.fill(0);
    out[1].bins[351] = 127;
  }
  return out;
}

struct Body {
  const char* name;
  DotKernel kernel;
};

std::vector<Body> bodies() {
  std::vector<Body> all = {{"scalar", &dot_products_scalar}};
#if defined(__x86_64__) || defined(__i386__)
  if (__builtin_cpu_supports("sse4.1")) all.push_back({"sse4.1", &dot_products_sse41});
  if (__builtin_cpu_supports("avx2")) all.push_back({"avx2", &dot_products_avx2});
  if (__builtin_cpu_supports("avx512vnni") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl"))
    all.push_back({"avx512vnni", &dot_products_avx512vnni});
#elif defined(__aarch64__)
  all.push_back({"neon", &dot_products_neon});
  if (cpu_features().dot_products) all.push_back({"dotprod", &dot_products_dotprod});
#elif defined(__arm__)
  if (cpu_features().neon) all.push_back({"neon", &dot_products_neon});
#endif
  return all;
}

TEST(DescriptorMatch, AllBodiesGiveTheSameBits) {
  const std::vector<Descriptor> queries = random_descriptors(4, 1);
  for (const std::size_t count : {1U, 2U, 3U, 17U, 500U}) {
    const std::vector<Descriptor> candidates = random_descriptors(count, 2);
    std::vector<std::uint32_t> which;
    for (std::size_t k = count; k > 0; --k) which.push_back(static_cast<std::uint32_t>(k - 1));
    for (const Descriptor& query : queries) {
      std::vector<std::int16_t> expected(count), got(count + 1);
      dot_products_scalar(query, candidates.data(), which.data(), count, expected.data());
      int sum = 0;
      for (std::size_t k = 0; k < kDescriptorSize; ++k) sum += query.bins[k] * candidates[0].bins[k];
      EXPECT_EQ(expected[count - 1], sum);
      for (const Body& body : bodies()) {
        std::fill(got.begin(), got.end(), std::int16_t{-1});
        body.kernel(query, candidates.data(), which.data(), count, got.data());
        EXPECT_EQ(got[count], -1) << body.name;
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), got.begin())) << body.name << " " << count;
      }
    }
  }
}

TEST(DescriptorMatch, TheSettingChoosesABodyThatRunsHere) {
  for (const Kernels k : {Kernels::automatic, Kernels::scalar, Kernels::sse, Kernels::avx2, Kernels::neon})
    EXPECT_NE(dot_kernel(k), nullptr);
  EXPECT_EQ(dot_kernel(Kernels::scalar), &dot_products_scalar);
#if defined(__aarch64__)
  EXPECT_EQ(dot_kernel(Kernels::neon), &dot_products_neon);
  EXPECT_EQ(dot_kernel(Kernels::automatic),
            cpu_features().dot_products ? &dot_products_dotprod : &dot_products_neon);
#endif
}

TEST(DescriptorMatch, FindsTheBestAndTheNextBest) {
  const std::vector<Descriptor> queries = random_descriptors(37, 3), candidates = random_descriptors(300, 4);
  AlignedBlock block(1 << 20);
  Workspace workspace(block.span());
  DescriptorMatcher matcher;
  matcher.lay_out(workspace, candidates.size());
  matcher.start(Kernels::automatic);
  std::vector<Match> matches(queries.size() * 3);
  matcher.prepare(candidates);
  matcher.match(queries, 3, matches);
  for (std::size_t q = 0; q < queries.size(); ++q) {
    std::vector<std::pair<int, int>> all;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      int sum = 0;
      for (std::size_t k = 0; k < kDescriptorSize; ++k) sum += queries[q].bins[k] * candidates[c].bins[k];
      all.emplace_back(-sum, static_cast<int>(c));
    }
    std::sort(all.begin(), all.end());
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(matches[q * 3 + k].scene, q);
      EXPECT_EQ(matches[q * 3 + k].model, all[k].second);
      EXPECT_EQ(matches[q * 3 + k].dot, -all[k].first);
    }
  }
}

std::vector<std::pair<const char*, BoundKernels>> bound_bodies() {
  std::vector<std::pair<const char*, BoundKernels>> all;
  all.emplace_back("scalar", BoundKernels());
#if defined(__x86_64__) || defined(__i386__)
  if (__builtin_cpu_supports("sse4.1"))
    all.emplace_back(
        "sse4.1", BoundKernels{&descriptor_bounds_sse41, &select_bounds_scalar, &project_descriptor_scalar});
  if (__builtin_cpu_supports("avx2"))
    all.emplace_back("avx2",
                     BoundKernels{&descriptor_bounds_avx2, &select_bounds_avx2, &project_descriptor_avx2});
#endif
  all.emplace_back("automatic", bound_kernels(Kernels::automatic));
  return all;
}

TEST(DescriptorBounds, AllBodiesGiveTheSameBits) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> number(-4366, 4366);
  for (const std::size_t blocks : {1U, 2U, 31U}) {
    std::vector<ShortForm> queries(kBoundQueries);
    for (ShortForm& q : queries)
      for (std::int16_t& x : q.numbers) x = static_cast<std::int16_t>(number(random));
    std::vector<std::int16_t> candidates(blocks * kBoundLanes * kBoundNumbers);
    for (std::int16_t& x : candidates) x = static_cast<std::int16_t>(number(random));
    // Equal candidates: the first must lead.
    for (std::size_t k = 0; k < kBoundNumbers / 2; ++k)
      for (std::size_t b = 1; b < blocks; ++b)
        for (std::size_t j = 0; j < 2; ++j)
          candidates[b * kBoundLanes * kBoundNumbers + (k * kBoundLanes + 5) * 2 + j] =
              candidates[(k * kBoundLanes + 5) * 2 + j];
    const std::size_t count = kBoundQueries * blocks * kBoundLanes;
    std::vector<std::int32_t> expected(count), got(count);
    std::vector<std::uint32_t> lead(kBoundQueries * kBoundLanes), got_lead(lead.size());
    descriptor_bounds_scalar(queries.data(), candidates.data(), blocks, expected.data(), lead.data());
    for (std::size_t q = 0; q < kBoundQueries; ++q) EXPECT_EQ(lead[q * kBoundLanes + 5], 5U);
    for (const auto& [name, kernels] : bound_bodies()) {
      std::fill(got.begin(), got.end(), -1);
      kernels.bounds(queries.data(), candidates.data(), blocks, got.data(), got_lead.data());
      EXPECT_EQ(got, expected) << name << " " << blocks;
      EXPECT_EQ(got_lead, lead) << name << " " << blocks;
      for (const std::size_t some : {count, count - 3, std::size_t{1}}) {
        std::vector<std::uint32_t> selected(some + kBoundLanes), chosen(some + kBoundLanes);
        const std::size_t left = select_bounds_scalar(got.data(), some, got[some / 2], selected.data());
        EXPECT_EQ(kernels.select(got.data(), some, got[some / 2], chosen.data()), left) << name;
        EXPECT_TRUE(std::equal(selected.begin(), selected.begin() + static_cast<std::ptrdiff_t>(left),
                               chosen.begin()))
            << name << " " << some;
      }
    }
  }
}

TEST(DescriptorBounds, AllBodiesProjectToTheSameBits) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> number(-1, 1);
  std::vector<float> basis(kDescriptorSize * kBoundNumbers);
  for (float& b : basis) b = number(random);
  for (const Descriptor& d : random_descriptors(4, 9)) {
    float expected[kBoundNumbers], got[kBoundNumbers];
    project_descriptor_scalar(d, basis.data(), expected);
    for (const auto& [name, kernels] : bound_bodies()) {
      kernels.project(d, basis.data(), got);
      for (std::size_t k = 0; k < kBoundNumbers; ++k) EXPECT_EQ(got[k], expected[k]) << name << " " << k;
    }
  }
}

TEST(DescriptorBounds, NoDotProductIsAboveItsBound) {
  for (const std::size_t count : {1U, 5U, 40U, 700U}) {
    std::vector<Descriptor> candidates = random_descriptors(count, 11);
    for (std::size_t k = 2; k < count; k += 7) candidates[k] = candidates[k / 2];
    std::vector<Descriptor> queries = random_descriptors(kBoundQueries, 12);
    queries[2] = candidates[count / 2];
    AlignedBlock block(1 << 20);
    Workspace workspace(block.span());
    DescriptorBounds bounds;
    bounds.lay_out(workspace, count);
    bounds.start(Kernels::automatic);
    bounds.build(candidates);
    std::vector<std::int32_t> got(kBoundQueries * bounds.padded_size());
    std::uint32_t lead[kBoundQueries * kBoundLanes];
    bounds.bounds(queries.data(), got.data(), lead);
    for (std::size_t q = 0; q < kBoundQueries; ++q)
      for (std::size_t c = 0; c < count; ++c) {
        int sum = 0;
        for (std::size_t k = 0; k < kDescriptorSize; ++k) sum += queries[q].bins[k] * candidates[c].bins[k];
        EXPECT_GE(got[q * bounds.padded_size() + c], DescriptorBounds::least_bound(sum)) << q << " " << c;
        EXPECT_LE(sum, kBoundSlack + 18605);
      }
  }
}

TEST(DescriptorMatch, EqualDescriptorsGiveTheFirst) {
  std::vector<Descriptor> candidates(100, random_descriptors(5, 13)[4]);
  AlignedBlock block(1 << 20);
  Workspace workspace(block.span());
  DescriptorMatcher matcher;
  matcher.lay_out(workspace, candidates.size());
  matcher.start(Kernels::automatic);
  matcher.prepare(candidates);
  std::vector<Match> matches(3 * 5);
  matcher.match(std::span(candidates).first(5), 3, matches);
  for (std::size_t k = 0; k < matches.size(); ++k) EXPECT_EQ(matches[k].model, k % 3);
}

TEST(DescriptorMatch, BearsFewerCandidatesThanAskedFor) {
  const std::vector<Descriptor> queries = random_descriptors(3, 5), candidates = random_descriptors(2, 6);
  AlignedBlock block(1 << 16);
  Workspace workspace(block.span());
  DescriptorMatcher matcher;
  matcher.lay_out(workspace, 2);
  std::vector<Match> matches(12);
  matcher.prepare(candidates);
  matcher.match(queries, 4, matches);
  for (const Match& m : matches) EXPECT_LT(m.model, 2);
  matcher.prepare({});
  matcher.match(queries, 4, matches);
}

LocalFrame frame_of(const Matrix3& axes) {
  LocalFrame f;
  for (int i = 0; i < 9; ++i)
    f.axes[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(std::lround(axes(i / 3, i % 3) * 16384));
  return f;
}

/// Matches of which every `stride`-th obeys `pose`, with local frames off by up to 5°.
std::vector<PosedMatch> mixed_matches(std::size_t count, std::size_t stride, const RigidTransform& pose) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> spread(-0.15, 0.15), angle(0, 6.28), small(-0.05, 0.05);
  std::vector<PosedMatch> matches;
  for (std::size_t i = 0; i < count; ++i) {
    PosedMatch m;
    const Vector3 p(spread(random), spread(random), spread(random));
    const bool right = i % stride == 0;
    const Vector3 q = right ? pose * p + 0.01 * Vector3(spread(random), spread(random), spread(random))
                            : Vector3(4 * spread(random), 4 * spread(random), 4 * spread(random));
    const Matrix3 axes =
        testing::test_pose(angle(random), Vector3(small(random), 1, 0.2), Vector3::Zero()).rotation;
    const Matrix3 wobble =
        testing::test_pose(small(random), Vector3(1, small(random), 0.3), Vector3::Zero()).rotation;
    m.model = to_point(p);
    m.scene = to_point(q);
    m.model_frame = frame_of(axes);
    m.scene_frame =
        right
            ? frame_of(wobble * axes * pose.rotation.transpose())
            : frame_of(
                  testing::test_pose(angle(random), Vector3(1, small(random), 0), Vector3::Zero()).rotation);
    m.quality = 10000 + static_cast<int>((i * 37) % 1000);
    matches.push_back(m);
  }
  return matches;
}

struct GroupingFixture {
  GroupingFixture() : block(4 << 20) {
    Workspace workspace(block.span());
    grouping.lay_out(workspace, 5000);
  }
  AlignedBlock block;
  Grouping grouping;
};

TEST(Grouping, FindsThePoseAmongNinetyPerCentWrongMatches) {
  const RigidTransform pose = testing::test_pose(2.1, Vector3(0.3, -1, 0.8), Vector3(0.2, 0.4, 1.1));
  const std::vector<PosedMatch> matches = mixed_matches(1000, 10, pose);
  for (const bool frames : {true, false}) {
    GroupingFixture fixture;
    std::array<MatchGroup, 4> groups;
    GroupingSettings settings;
    settings.use_frames = frames;
    settings.seeds = 512;
    ASSERT_GT(fixture.grouping.group(matches, settings, 0.2, groups), 0U) << frames;
    EXPECT_GE(groups[0].members, 95U);
    EXPECT_LT(testing::degrees_between(groups[0].transform.rotation, pose.rotation), 0.3);
    EXPECT_LT((groups[0].transform.translation - pose.translation).norm(), 0.001);
  }
}

TEST(Grouping, SameAnswerInAnyOrderOfTheMatches) {
  const RigidTransform pose = testing::test_pose(1.2, Vector3(0.3, 1, 0.8), Vector3(0.2, 0.4, 1.1));
  std::vector<PosedMatch> matches = mixed_matches(600, 6, pose);
  std::array<MatchGroup, 4> first, second;
  GroupingFixture a, b;
  GroupingSettings settings;
  settings.seeds = 600;
  ASSERT_GT(a.grouping.group(matches, settings, 0.2, first), 0U);
  std::reverse(matches.begin(), matches.end());
  ASSERT_GT(b.grouping.group(matches, settings, 0.2, second), 0U);
  EXPECT_EQ(first[0].members, second[0].members);
  EXPECT_LT(testing::degrees_between(first[0].transform.rotation, second[0].transform.rotation), 0.05);
}

TEST(Grouping, SaysNothingOfScatteredMatchesAndFewOfThem) {
  GroupingFixture fixture;
  std::array<MatchGroup, 4> groups;
  const std::vector<PosedMatch> noise = mixed_matches(400, 100000, RigidTransform());
  const std::size_t found = fixture.grouping.group(noise, GroupingSettings(), 0.2, groups);
  for (std::size_t g = 0; g < found; ++g) EXPECT_LT(groups[g].members, 8U);
  EXPECT_EQ(fixture.grouping.group({}, GroupingSettings(), 0.2, groups), 0U);
  EXPECT_EQ(fixture.grouping.group(std::span(noise).first(2), GroupingSettings(), 0.2, groups), 0U);
}

TEST(Grouping, BearsMatchesThatAllAgreeAndMatchesOnALine) {
  GroupingFixture fixture;
  std::array<MatchGroup, 4> groups;
  const std::vector<PosedMatch> all = mixed_matches(5000, 1, RigidTransform());
  ASSERT_GT(fixture.grouping.group(all, GroupingSettings(), 0.2, groups), 0U);
  EXPECT_GT(groups[0].members, 4900U);
  std::vector<PosedMatch> line = mixed_matches(50, 1, RigidTransform());
  for (std::size_t i = 0; i < line.size(); ++i)
    line[i].model = line[i].scene = {0.001F * static_cast<float>(i), 0, 0};
  EXPECT_EQ(fixture.grouping.group(line, GroupingSettings(), 0.2, groups), 0U);
  std::vector<PosedMatch> one(300, all[0]);
  EXPECT_EQ(fixture.grouping.group(one, GroupingSettings(), 0.2, groups), 0U);
}

}  // namespace
}  // namespace pliant

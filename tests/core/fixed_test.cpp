#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/fixed/integer_root.hpp"
#include "core/fixed/moments.hpp"

namespace pliant {
namespace {

void expect_root(std::uint32_t x) {
  const std::uint64_t r = integer_sqrt(x);
  ASSERT_LE(r * r, x) << x;
  ASSERT_GT((r + 1) * (r + 1), x) << x;
}

TEST(IntegerRoot, IsExactAroundEverySquare) {
  for (std::uint64_t r = 0; r <= 65535; ++r) {
    const std::uint64_t square = r * r;
    expect_root(static_cast<std::uint32_t>(square));
    if (square > 0) expect_root(static_cast<std::uint32_t>(square - 1));
    expect_root(static_cast<std::uint32_t>(square + 1));
  }
  expect_root(std::numeric_limits<std::uint32_t>::max());
}

struct Row {
  std::array<std::int32_t, 6> j;
  std::int32_t residual, weight;
};

PlaneMoments sum(const std::vector<Row>& rows) {
  PlaneMoments m;
  for (const Row& row : rows) m.add(row.j, row.residual, row.weight);
  return m;
}

TEST(PlaneMoments, AreExactInAnyOrder) {
  std::mt19937 random(3);
  const auto below = [&](std::int32_t most) {
    return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(2 * most + 1)) - most;
  };
  std::vector<Row> rows(2000);
  for (Row& row : rows) {
    for (std::size_t k = 0; k < 6; ++k) row.j[k] = below(k < 3 ? 65535 : 16384);
    row.residual = below((1 << 18) - 1);
    row.weight = static_cast<std::int32_t>(random() % 257);
  }
  const PlaneMoments one = sum(rows);
  std::shuffle(rows.begin(), rows.end(), random);
  const PlaneMoments other = sum(rows);
  EXPECT_EQ(one.a, other.a);
  EXPECT_EQ(one.b, other.b);
  EXPECT_EQ(one.square, other.square);
  EXPECT_EQ(one.weight, other.weight);
  EXPECT_EQ(one.rows, 2000U);
  PlaneMoments both = sum({rows.begin(), rows.begin() + 700});
  both.add(sum({rows.begin() + 700, rows.end()}));
  EXPECT_EQ(both.a, one.a);
  EXPECT_EQ(both.b, one.b);
  EXPECT_EQ(both.square, one.square);
  EXPECT_EQ(both.weight, one.weight);
  EXPECT_EQ(both.rows, one.rows);
  // against wide arithmetic, where the compiler has it
#ifdef __SIZEOF_INT128__
  __extension__ using Wide = __int128;
#else
  using Wide = std::int64_t;
#endif
  std::size_t k = 0;
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t c = r; c < 6; ++c) {
      Wide exact = 0;
      for (const Row& row : rows) exact += static_cast<Wide>(row.weight) * row.j[r] * row.j[c];
      EXPECT_EQ(static_cast<Wide>(one.a[k++]), exact);
    }
}

TEST(PlaneMoments, HoldTheMostThatAModelCanGive) {
  constexpr std::int64_t kRows = 16384;
  PlaneMoments m;
  constexpr std::int32_t kArm = 65535, kNormal = 16384, kResidual = (1 << 18) - 1;
  for (int i = 0; i < kRows; ++i) m.add({kArm, -kArm, kArm, kNormal, -kNormal, kNormal}, -kResidual, 256);
  EXPECT_EQ(m.a[0], kRows * 256 * kArm * kArm);
  EXPECT_EQ(m.a[1], -kRows * 256 * kArm * kArm);
  EXPECT_EQ(m.a[20], kRows * 256 * kNormal * kNormal);
  EXPECT_EQ(m.b[0], -kRows * 256 * kArm * kResidual);
  EXPECT_EQ(m.square, kRows * 256 * kResidual * kResidual);
  EXPECT_GT(m.square, 0);
}

TEST(PlaneMoments, SolveLikeDoublePrecision) {
  // Signal to noise of the normal equations from rounded rows against those from the real ones.
  std::mt19937 random(5);
  const auto uniform = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  PlaneMoments m;
  std::array<double, 21> exact{};
  for (int i = 0; i < 500; ++i) {
    std::array<double, 6> real{};
    for (std::size_t k = 0; k < 6; ++k) real[k] = uniform() * (k < 3 ? 1600.0 : 16384.0);  // 10 cm arms
    std::array<std::int32_t, 6> rounded{};
    for (std::size_t k = 0; k < 6; ++k) rounded[k] = static_cast<std::int32_t>(std::floor(real[k] + 0.5));
    m.add(rounded, 0, 256);
    std::size_t e = 0;
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t c = r; c < 6; ++c) exact[e++] += 256 * real[r] * real[c];
  }
  double signal = 0, noise = 0;
  for (std::size_t k = 0; k < 21; ++k) {
    const double error = static_cast<double>(m.a[k]) - exact[k];
    signal += exact[k] * exact[k];
    noise += error * error;
  }
  EXPECT_GT(10 * std::log10(signal / noise), 70.0);
}

}  // namespace
}  // namespace pliant

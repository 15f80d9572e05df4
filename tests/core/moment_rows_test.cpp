#include "core/fixed/moment_rows.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace pliant {
namespace {

void expect_equal(const PlaneMoments& a, const PlaneMoments& b) {
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.b, b.b);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.square, b.square);
  EXPECT_EQ(a.rows, b.rows);
}

/// What every body makes of rows, on top of what is there, beside PlaneMoments::add() row by row.
void expect_all_bodies_agree(const std::vector<MomentRow>& rows) {
  PlaneMoments start;
  start.add({7, -3, 1, 2, 9, -8}, -5, 3);
  PlaneMoments expected = start;
  for (const MomentRow& row : rows) expected.add(row.j, row.residual, row.weight);
  for (const Kernels kernels : {Kernels::scalar, Kernels::sse, Kernels::avx2, Kernels::neon}) {
    PlaneMoments moments = start;
    add_moment_rows(simd_body(kernels))(rows.data(), rows.size(), moments);
    SCOPED_TRACE(static_cast<int>(kernels));
    expect_equal(moments, expected);
  }
}

std::int32_t below(std::mt19937& random, std::int32_t most) {
  return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(2 * most + 1)) - most;
}

TEST(MomentRows, AllBodiesGiveTheBitsOfOneByOne) {
  std::mt19937 random(5);
  for (std::size_t count = 0; count < 70; ++count) {
    std::vector<MomentRow> rows(count);
    for (MomentRow& row : rows) {
      for (std::size_t k = 0; k < 6; ++k) row.j[k] = below(random, k < 3 ? 65535 : 16384);
      row.residual = below(random, (1 << 18) - 1);
      row.weight = static_cast<std::int32_t>(random() % 257);
    }
    expect_all_bodies_agree(rows);
  }
}

TEST(MomentRows, AllBodiesAgreeAtTheBounds) {
  std::vector<MomentRow> rows;
  for (unsigned signs = 0; signs < 128; ++signs) {
    MomentRow row;
    for (std::size_t k = 0; k < 6; ++k)
      row.j[k] = (k < 3 ? 65535 : 16384) * ((signs >> k & 1U) != 0 ? -1 : 1);
    row.residual = ((1 << 18) - 1) * ((signs >> 6 & 1U) != 0 ? -1 : 1);
    row.weight = 256;
    rows.push_back(row);
  }
  for (int times = 0; times < 7; ++times) rows.insert(rows.end(), rows.begin(), rows.end());  // 2^14
  expect_all_bodies_agree(rows);
}

TEST(MomentRows, ABufferPassesEveryRowOn) {
  std::mt19937 random(6);
  for (const std::size_t count : {0U, 1U, 63U, 64U, 65U, 200U}) {
    PlaneMoments expected, moments;
    MomentRowBuffer buffer(add_moment_rows_scalar, moments);
    for (std::size_t k = 0; k < count; ++k) {
      const MomentRow row{{below(random, 99), 1, 2, 3, 4, below(random, 99)}, below(random, 99), 200};
      expected.add(row.j, row.residual, row.weight);
      buffer.add(row);
    }
    buffer.flush();
    expect_equal(moments, expected);
  }
}

}  // namespace
}  // namespace pliant

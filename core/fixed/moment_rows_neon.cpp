// Two 64-bit sums in a vector: pairs of the matrix' rows, a column a vector.
#include <arm_neon.h>

#include "core/fixed/moment_rows.hpp"

namespace pliant {

namespace {

void add_pair(std::int64_t& first, std::int64_t& second, int64x2_t sum) noexcept {
  first += vgetq_lane_s64(sum, 0);
  second += vgetq_lane_s64(sum, 1);
}

}  // namespace

void add_moment_rows_neon(const MomentRow* rows, std::size_t count, PlaneMoments& moments) noexcept {
  const int64x2_t none = vdupq_n_s64(0);
  // Rows 0 and 1, rows 2 and 3, rows 4 and 5, by column; r: of the right side.
  int64x2_t a0 = none, a1 = none, a2 = none, a3 = none, a4 = none, a5 = none, ar = none;
  int64x2_t c2 = none, c3 = none, c4 = none, c5 = none, cr = none;
  int64x2_t e4 = none, e5 = none, er = none;
  std::int64_t weight = 0, square = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const MomentRow& row = rows[k];
    const int32x4_t four = vld1q_s32(row.j.data());
    const int32x2_t j01 = vget_low_s32(four), j23 = vget_high_s32(four), j45 = vld1_s32(&row.j[4]);
    const int32x2_t a = vmul_n_s32(j01, row.weight), c = vmul_n_s32(j23, row.weight),
                    e = vmul_n_s32(j45, row.weight);
    a0 = vmlal_lane_s32(a0, a, j01, 0);
    a1 = vmlal_lane_s32(a1, a, j01, 1);
    a2 = vmlal_lane_s32(a2, a, j23, 0);
    a3 = vmlal_lane_s32(a3, a, j23, 1);
    a4 = vmlal_lane_s32(a4, a, j45, 0);
    a5 = vmlal_lane_s32(a5, a, j45, 1);
    ar = vmlal_n_s32(ar, a, row.residual);
    c2 = vmlal_lane_s32(c2, c, j23, 0);
    c3 = vmlal_lane_s32(c3, c, j23, 1);
    c4 = vmlal_lane_s32(c4, c, j45, 0);
    c5 = vmlal_lane_s32(c5, c, j45, 1);
    cr = vmlal_n_s32(cr, c, row.residual);
    e4 = vmlal_lane_s32(e4, e, j45, 0);
    e5 = vmlal_lane_s32(e5, e, j45, 1);
    er = vmlal_n_s32(er, e, row.residual);
    weight += row.weight;
    square += static_cast<std::int64_t>(row.weight * row.residual) * row.residual;
  }
  std::int64_t below = 0;  // what lies below the diagonal is not kept
  auto& m = moments.a;
  add_pair(m[0], below, a0);
  add_pair(m[1], m[6], a1);
  add_pair(m[2], m[7], a2);
  add_pair(m[3], m[8], a3);
  add_pair(m[4], m[9], a4);
  add_pair(m[5], m[10], a5);
  add_pair(m[11], below, c2);
  add_pair(m[12], m[15], c3);
  add_pair(m[13], m[16], c4);
  add_pair(m[14], m[17], c5);
  add_pair(m[18], below, e4);
  add_pair(m[19], m[20], e5);
  add_pair(moments.b[0], moments.b[1], ar);
  add_pair(moments.b[2], moments.b[3], cr);
  add_pair(moments.b[4], moments.b[5], er);
  moments.weight += weight;
  moments.square += square;
  moments.rows += static_cast<std::uint32_t>(count);
}

}  // namespace pliant

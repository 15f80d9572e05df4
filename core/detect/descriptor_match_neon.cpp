// 16 products in two instructions (smlal, smlal2), 16-bit sums: see descriptor_match.hpp for the bound.
#include <arm_neon.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

namespace {

std::int16_t sum_of(int16x8_t lanes) {
  const int32x4_t pairs = vpaddlq_s16(lanes);
  const int64x2_t quads = vpaddlq_s32(pairs);
  return static_cast<std::int16_t>(vgetq_lane_s64(quads, 0) + vgetq_lane_s64(quads, 1));
}

}  // namespace

void dot_products_neon(const Descriptor* queries, const Descriptor* candidates, std::size_t count,
                       std::int16_t* dots) noexcept {
  for (std::size_t c = 0; c < count; ++c) {
    int16x8_t sum[kDotQueries] = {vdupq_n_s16(0), vdupq_n_s16(0), vdupq_n_s16(0), vdupq_n_s16(0)};
    const std::int8_t* candidate = candidates[c].bins.data();
    for (std::size_t i = 0; i < kDescriptorSize; i += 16) {
      const int8x16_t b = vld1q_s8(candidate + i);
      for (std::size_t q = 0; q < kDotQueries; ++q) {
        const int8x16_t a = vld1q_s8(queries[q].bins.data() + i);
        sum[q] = vmlal_s8(sum[q], vget_low_s8(a), vget_low_s8(b));
        sum[q] = vmlal_s8(sum[q], vget_high_s8(a), vget_high_s8(b));
      }
    }
    for (std::size_t q = 0; q < kDotQueries; ++q) dots[q * count + c] = sum_of(sum[q]);
  }
}

}  // namespace pliant

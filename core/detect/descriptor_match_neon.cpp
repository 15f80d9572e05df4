// 16 products in two instructions (smlal, smlal2), 16-bit sums: see descriptor_match.hpp for the bound.
#include <arm_neon.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_neon(const Descriptor& query, const Descriptor* candidates, const std::uint32_t* which,
                       std::size_t count, std::int16_t* dots) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    int16x8_t low = vdupq_n_s16(0), high = vdupq_n_s16(0);
    const std::int8_t* candidate = candidates[which[k]].bins.data();
    for (std::size_t i = 0; i < kDescriptorSize; i += 16) {
      const int8x16_t a = vld1q_s8(query.bins.data() + i), b = vld1q_s8(candidate + i);
      low = vmlal_s8(low, vget_low_s8(a), vget_low_s8(b));
      high = vmlal_s8(high, vget_high_s8(a), vget_high_s8(b));
    }
    const int64x2_t quads = vpaddlq_s32(vpaddlq_s16(vaddq_s16(low, high)));
    dots[k] = static_cast<std::int16_t>(vgetq_lane_s64(quads, 0) + vgetq_lane_s64(quads, 1));
  }
}

}  // namespace pliant

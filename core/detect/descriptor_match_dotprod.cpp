// 16 products an instruction (sdot), 32-bit sums.
#include <arm_neon.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_dotprod(const Descriptor* queries, const Descriptor* candidates, std::size_t count,
                          std::int16_t* dots) noexcept {
  for (std::size_t c = 0; c < count; ++c) {
    int32x4_t sum[kDotQueries] = {vdupq_n_s32(0), vdupq_n_s32(0), vdupq_n_s32(0), vdupq_n_s32(0)};
    const std::int8_t* candidate = candidates[c].bins.data();
    for (std::size_t i = 0; i < kDescriptorSize; i += 16) {
      const int8x16_t b = vld1q_s8(candidate + i);
      for (std::size_t q = 0; q < kDotQueries; ++q)
        sum[q] = vdotq_s32(sum[q], vld1q_s8(queries[q].bins.data() + i), b);
    }
    for (std::size_t q = 0; q < kDotQueries; ++q)
      dots[q * count + c] = static_cast<std::int16_t>(vaddvq_s32(sum[q]));
  }
}

}  // namespace pliant

// 16 products an instruction (sdot), 32-bit sums.
#include <arm_neon.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_dotprod(const Descriptor& query, const Descriptor* candidates, const std::uint32_t* which,
                          std::size_t count, std::int16_t* dots) noexcept {
  for (std::size_t k = 0; k < count; ++k) {
    int32x4_t even = vdupq_n_s32(0), odd = vdupq_n_s32(0);
    const std::int8_t* candidate = candidates[which[k]].bins.data();
    for (std::size_t i = 0; i < kDescriptorSize; i += 32) {
      even = vdotq_s32(even, vld1q_s8(query.bins.data() + i), vld1q_s8(candidate + i));
      odd = vdotq_s32(odd, vld1q_s8(query.bins.data() + i + 16), vld1q_s8(candidate + i + 16));
    }
    dots[k] = static_cast<std::int16_t>(vaddvq_s32(vaddq_s32(even, odd)));
  }
}

}  // namespace pliant

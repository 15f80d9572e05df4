// Four candidates an instruction, their even and odd numbers apart (smlal), 32-bit sums.
#include <arm_neon.h>

#include "core/detect/descriptor_bounds.hpp"

namespace pliant {

void descriptor_bounds_neon(const ShortForm* queries, const std::int16_t* candidates, std::size_t blocks,
                            std::int32_t* bounds, std::uint32_t* lead) noexcept {
  constexpr std::size_t kRegisters = kBoundLanes / 4, kPairs = kBoundNumbers / 2;
  for (std::size_t r = 0; r < kRegisters; ++r) {
    const std::uint32_t first[4] = {0, 1, 2, 3};
    uint32x4_t at = vaddq_u32(vld1q_u32(first), vdupq_n_u32(static_cast<std::uint32_t>(4 * r)));
    int32x4_t most[kBoundQueries];
    uint32x4_t best[kBoundQueries];
    for (std::size_t q = 0; q < kBoundQueries; ++q) {
      most[q] = vdupq_n_s32(INT32_MIN);
      best[q] = at;
    }
    for (std::size_t block = 0; block < blocks; ++block) {
      const std::int16_t* pairs = candidates + block * kBoundLanes * kBoundNumbers + 8 * r;
      int32x4_t sum[kBoundQueries] = {vdupq_n_s32(0), vdupq_n_s32(0), vdupq_n_s32(0), vdupq_n_s32(0)};
      for (std::size_t k = 0; k < kPairs; ++k) {
        const int16x4x2_t candidate = vld2_s16(pairs + 2 * kBoundLanes * k);
        for (std::size_t q = 0; q < kBoundQueries; ++q) {
          sum[q] = vmlal_n_s16(sum[q], candidate.val[0], queries[q].numbers[2 * k]);
          sum[q] = vmlal_n_s16(sum[q], candidate.val[1], queries[q].numbers[2 * k + 1]);
        }
      }
      for (std::size_t q = 0; q < kBoundQueries; ++q) {
        vst1q_s32(bounds + (q * blocks + block) * kBoundLanes + 4 * r, sum[q]);
        best[q] = vbslq_u32(vcgtq_s32(sum[q], most[q]), at, best[q]);
        most[q] = vmaxq_s32(most[q], sum[q]);
      }
      at = vaddq_u32(at, vdupq_n_u32(kBoundLanes));
    }
    for (std::size_t q = 0; q < kBoundQueries; ++q) vst1q_u32(lead + q * kBoundLanes + 4 * r, best[q]);
  }
}

}  // namespace pliant

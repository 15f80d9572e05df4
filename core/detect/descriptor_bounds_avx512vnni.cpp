// Sixteen candidates an instruction (vpdpwssd), 32-bit sums.
#include <immintrin.h>

#include <cstring>

#include "core/detect/descriptor_bounds.hpp"

namespace pliant {

void descriptor_bounds_avx512vnni(const ShortForm* queries, const std::int16_t* candidates,
                                  std::size_t blocks, std::int32_t* bounds, std::uint32_t* lead) noexcept {
  constexpr std::size_t kPairs = kBoundNumbers / 2;
  std::int32_t pair[kBoundQueries][kPairs];
  std::memcpy(pair, queries, sizeof pair);
  __m512i at = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  __m512i most[kBoundQueries], best[kBoundQueries];
  for (std::size_t q = 0; q < kBoundQueries; ++q) {
    most[q] = _mm512_set1_epi32(INT32_MIN);
    best[q] = at;
  }
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::int16_t* pairs = candidates + block * kBoundLanes * kBoundNumbers;
    __m512i sum[kBoundQueries] = {_mm512_setzero_si512(), _mm512_setzero_si512(), _mm512_setzero_si512(),
                                  _mm512_setzero_si512()};
    for (std::size_t k = 0; k < kPairs; ++k) {
      const __m512i candidate = _mm512_loadu_si512(pairs + 2 * kBoundLanes * k);
      for (std::size_t q = 0; q < kBoundQueries; ++q)
        sum[q] = _mm512_dpwssd_epi32(sum[q], candidate, _mm512_set1_epi32(pair[q][k]));
    }
    for (std::size_t q = 0; q < kBoundQueries; ++q) {
      _mm512_storeu_si512(bounds + (q * blocks + block) * kBoundLanes, sum[q]);
      const __mmask16 more = _mm512_cmpgt_epi32_mask(sum[q], most[q]);
      best[q] = _mm512_mask_mov_epi32(best[q], more, at);
      most[q] = _mm512_mask_mov_epi32(most[q], more, sum[q]);
    }
    at = _mm512_add_epi32(at, _mm512_set1_epi32(kBoundLanes));
  }
  for (std::size_t q = 0; q < kBoundQueries; ++q) _mm512_storeu_si512(lead + q * kBoundLanes, best[q]);
}

std::size_t select_bounds_avx512vnni(const std::int32_t* bounds, std::size_t count, std::int32_t least,
                                     std::uint32_t* out) noexcept {
  const __m512i bound = _mm512_set1_epi32(least);
  __m512i at = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  std::size_t left = 0;
  for (std::size_t c = 0; c < count; c += kBoundLanes) {
    const auto valid = static_cast<__mmask16>(c + kBoundLanes <= count ? 0xFFFFU : (1U << (count - c)) - 1);
    const __mmask16 mask = _mm512_mask_cmpge_epi32_mask(valid, _mm512_loadu_si512(bounds + c), bound);
    if (mask != 0) {
      _mm512_storeu_si512(out + left, _mm512_maskz_compress_epi32(mask, at));
      left += static_cast<std::size_t>(__builtin_popcount(mask));
    }
    at = _mm512_add_epi32(at, _mm512_set1_epi32(kBoundLanes));
  }
  return left;
}

void project_descriptor_avx512vnni(const Descriptor& descriptor, const float* basis, float* along) noexcept {
  constexpr std::size_t kRegisters = kBoundNumbers / 16;
  __m512 sum[kRegisters];
  for (__m512& s : sum) s = _mm512_setzero_ps();
  for (std::size_t i = 0; i < kDescriptorSize; ++i) {
    const __m512 bin = _mm512_set1_ps(static_cast<float>(descriptor.bins[i]));
    for (std::size_t r = 0; r < kRegisters; ++r)
      sum[r] = _mm512_add_ps(sum[r], _mm512_mul_ps(bin, _mm512_loadu_ps(basis + i * kBoundNumbers + 16 * r)));
  }
  for (std::size_t r = 0; r < kRegisters; ++r) _mm512_storeu_ps(along + 16 * r, sum[r]);
}

}  // namespace pliant

// 64 products an instruction (vpdpbusd), 32-bit sums.
#include <immintrin.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_avx512vnni(const Descriptor* queries, const Descriptor* candidates, std::size_t count,
                             std::int16_t* dots) noexcept {
  // 352 = 5 · 64 + 32: the last load takes half.
  constexpr std::size_t kBlocks = 6;
  constexpr __mmask64 kHalf = 0xFFFFFFFFULL;
  const auto load = [](const Descriptor& d, std::size_t block) {
    const void* at = d.bins.data() + 64 * block;
    return block + 1 < kBlocks ? _mm512_loadu_si512(at) : _mm512_maskz_loadu_epi8(kHalf, at);
  };
  __m512i query[kDotQueries][kBlocks];
  for (std::size_t q = 0; q < kDotQueries; ++q)
    for (std::size_t b = 0; b < kBlocks; ++b) query[q][b] = load(queries[q], b);
  for (std::size_t c = 0; c < count; ++c) {
    __m512i sum[kDotQueries] = {_mm512_setzero_si512(), _mm512_setzero_si512(), _mm512_setzero_si512(),
                                _mm512_setzero_si512()};
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const __m512i candidate = load(candidates[c], b);
      for (std::size_t q = 0; q < kDotQueries; ++q)
        sum[q] = _mm512_dpbusd_epi32(sum[q], query[q][b], candidate);
    }
    __m256i half[kDotQueries];
    for (std::size_t q = 0; q < kDotQueries; ++q)
      half[q] = _mm256_add_epi32(_mm512_maskz_extracti64x4_epi64(0xF, sum[q], 0),
                                 _mm512_maskz_extracti64x4_epi64(0xF, sum[q], 1));
    const __m256i halves =
        _mm256_hadd_epi32(_mm256_hadd_epi32(half[0], half[1]), _mm256_hadd_epi32(half[2], half[3]));
    const __m128i all = _mm_add_epi32(_mm256_castsi256_si128(halves), _mm256_extracti128_si256(halves, 1));
    dots[c] = static_cast<std::int16_t>(_mm_extract_epi32(all, 0));
    dots[count + c] = static_cast<std::int16_t>(_mm_extract_epi32(all, 1));
    dots[2 * count + c] = static_cast<std::int16_t>(_mm_extract_epi32(all, 2));
    dots[3 * count + c] = static_cast<std::int16_t>(_mm_extract_epi32(all, 3));
  }
}

}  // namespace pliant

// 64 products an instruction (vpdpbusd), 32-bit sums.
#include <immintrin.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_avx512vnni(const Descriptor& query, const Descriptor* candidates,
                             const std::uint32_t* which, std::size_t count, std::int16_t* dots) noexcept {
  // 352 = 5 · 64 + 32: the last load takes half.
  constexpr std::size_t kBlocks = 6;
  constexpr __mmask64 kHalf = 0xFFFFFFFFULL;
  const auto load = [](const Descriptor& d, std::size_t block) {
    const void* at = d.bins.data() + 64 * block;
    return block + 1 < kBlocks ? _mm512_loadu_si512(at) : _mm512_maskz_loadu_epi8(kHalf, at);
  };
  __m512i part[kBlocks];
  for (std::size_t b = 0; b < kBlocks; ++b) part[b] = load(query, b);
  for (std::size_t first = 0; first < count; first += kDotGroup) {
    // Of an incomplete group the last is repeated.
    __m512i sum[kDotGroup] = {_mm512_setzero_si512(), _mm512_setzero_si512(), _mm512_setzero_si512(),
                              _mm512_setzero_si512()};
    for (std::size_t k = 0; k < kDotGroup; ++k) {
      const Descriptor& candidate = candidates[which[first + k < count ? first + k : count - 1]];
      for (std::size_t b = 0; b < kBlocks; ++b)
        sum[k] = _mm512_dpbusd_epi32(sum[k], part[b], load(candidate, b));
    }
    __m256i half[kDotGroup];
    for (std::size_t k = 0; k < kDotGroup; ++k)
      half[k] = _mm256_add_epi32(_mm512_maskz_extracti64x4_epi64(0xF, sum[k], 0),
                                 _mm512_maskz_extracti64x4_epi64(0xF, sum[k], 1));
    const __m256i halves =
        _mm256_hadd_epi32(_mm256_hadd_epi32(half[0], half[1]), _mm256_hadd_epi32(half[2], half[3]));
    const __m128i all = _mm_add_epi32(_mm256_castsi256_si128(halves), _mm256_extracti128_si256(halves, 1));
    alignas(16) std::int32_t four[kDotGroup];
    _mm_store_si128(static_cast<__m128i*>(static_cast<void*>(four)), all);
    for (std::size_t k = 0; k < kDotGroup && first + k < count; ++k)
      dots[first + k] = static_cast<std::int16_t>(four[k]);
  }
}

}  // namespace pliant

// 32 products an instruction (vpmaddubsw), 16-bit sums: see descriptor_match.hpp for the bound.
#include <immintrin.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_avx2(const Descriptor* queries, const Descriptor* candidates, std::size_t count,
                       std::int16_t* dots) noexcept {
  const auto load = [](const Descriptor& d, std::size_t i) {
    return _mm256_loadu_si256(static_cast<const __m256i*>(static_cast<const void*>(d.bins.data() + i)));
  };
  const __m256i ones = _mm256_set1_epi16(1);
  for (std::size_t c = 0; c < count; ++c) {
    __m256i sum[kDotQueries] = {_mm256_setzero_si256(), _mm256_setzero_si256(), _mm256_setzero_si256(),
                                _mm256_setzero_si256()};
    for (std::size_t i = 0; i < kDescriptorSize; i += 32) {
      const __m256i candidate = load(candidates[c], i);
      for (std::size_t q = 0; q < kDotQueries; ++q)
        sum[q] = _mm256_add_epi16(sum[q], _mm256_maddubs_epi16(load(queries[q], i), candidate));
    }
    for (std::size_t q = 0; q < kDotQueries; ++q) sum[q] = _mm256_madd_epi16(sum[q], ones);
    const __m256i halves =
        _mm256_hadd_epi32(_mm256_hadd_epi32(sum[0], sum[1]), _mm256_hadd_epi32(sum[2], sum[3]));
    const __m128i all = _mm_add_epi32(_mm256_castsi256_si128(halves), _mm256_extracti128_si256(halves, 1));
    dots[c] = static_cast<std::int16_t>(_mm_extract_epi32(all, 0));
    dots[count + c] = static_cast<std::int16_t>(_mm_extract_epi32(all, 1));
    dots[2 * count + c] = static_cast<std::int16_t>(_mm_extract_epi32(all, 2));
    dots[3 * count + c] = static_cast<std::int16_t>(_mm_extract_epi32(all, 3));
  }
}

}  // namespace pliant

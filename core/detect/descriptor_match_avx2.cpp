// 32 products an instruction (vpmaddubsw), 16-bit sums: see descriptor_match.hpp for the bound.
#include <immintrin.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_avx2(const Descriptor& query, const Descriptor* candidates, const std::uint32_t* which,
                       std::size_t count, std::int16_t* dots) noexcept {
  const auto load = [](const Descriptor& d, std::size_t i) {
    return _mm256_loadu_si256(static_cast<const __m256i*>(static_cast<const void*>(d.bins.data() + i)));
  };
  const __m256i ones = _mm256_set1_epi16(1);
  for (std::size_t first = 0; first < count; first += kDotGroup) {
    // Of an incomplete group the last is repeated.
    const Descriptor* d[kDotGroup];
    for (std::size_t k = 0; k < kDotGroup; ++k)
      d[k] = candidates + which[first + k < count ? first + k : count - 1];
    __m256i sum[kDotGroup] = {_mm256_setzero_si256(), _mm256_setzero_si256(), _mm256_setzero_si256(),
                              _mm256_setzero_si256()};
    for (std::size_t i = 0; i < kDescriptorSize; i += 32) {
      const __m256i part = load(query, i);
      for (std::size_t k = 0; k < kDotGroup; ++k)
        sum[k] = _mm256_add_epi16(sum[k], _mm256_maddubs_epi16(part, load(*d[k], i)));
    }
    for (std::size_t k = 0; k < kDotGroup; ++k) sum[k] = _mm256_madd_epi16(sum[k], ones);
    const __m256i halves =
        _mm256_hadd_epi32(_mm256_hadd_epi32(sum[0], sum[1]), _mm256_hadd_epi32(sum[2], sum[3]));
    const __m128i all = _mm_add_epi32(_mm256_castsi256_si128(halves), _mm256_extracti128_si256(halves, 1));
    alignas(16) std::int32_t four[kDotGroup];
    _mm_store_si128(static_cast<__m128i*>(static_cast<void*>(four)), all);
    for (std::size_t k = 0; k < kDotGroup && first + k < count; ++k)
      dots[first + k] = static_cast<std::int16_t>(four[k]);
  }
}

}  // namespace pliant

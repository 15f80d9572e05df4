// 16 products an instruction (pmaddubsw), 16-bit sums: see descriptor_match.hpp for the bound.
#include <smmintrin.h>

#include "core/detect/descriptor_match.hpp"

namespace pliant {

void dot_products_sse41(const Descriptor& query, const Descriptor* candidates, const std::uint32_t* which,
                        std::size_t count, std::int16_t* dots) noexcept {
  const auto load = [](const Descriptor& d, std::size_t i) {
    return _mm_loadu_si128(static_cast<const __m128i*>(static_cast<const void*>(d.bins.data() + i)));
  };
  const __m128i ones = _mm_set1_epi16(1);
  for (std::size_t first = 0; first < count; first += kDotGroup) {
    // Of an incomplete group the last is repeated.
    const Descriptor* d[kDotGroup];
    for (std::size_t k = 0; k < kDotGroup; ++k)
      d[k] = candidates + which[first + k < count ? first + k : count - 1];
    __m128i sum[kDotGroup] = {_mm_setzero_si128(), _mm_setzero_si128(), _mm_setzero_si128(),
                              _mm_setzero_si128()};
    for (std::size_t i = 0; i < kDescriptorSize; i += 16) {
      const __m128i part = load(query, i);
      for (std::size_t k = 0; k < kDotGroup; ++k)
        sum[k] = _mm_add_epi16(sum[k], _mm_maddubs_epi16(part, load(*d[k], i)));
    }
    for (std::size_t k = 0; k < kDotGroup; ++k) sum[k] = _mm_madd_epi16(sum[k], ones);
    const __m128i all = _mm_hadd_epi32(_mm_hadd_epi32(sum[0], sum[1]), _mm_hadd_epi32(sum[2], sum[3]));
    alignas(16) std::int32_t four[kDotGroup];
    _mm_store_si128(static_cast<__m128i*>(static_cast<void*>(four)), all);
    for (std::size_t k = 0; k < kDotGroup && first + k < count; ++k)
      dots[first + k] = static_cast<std::int16_t>(four[k]);
  }
}

}  // namespace pliant

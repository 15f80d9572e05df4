// Four candidates an instruction (pmaddwd), 32-bit sums.
#include <smmintrin.h>

#include "core/detect/descriptor_bounds.hpp"

namespace pliant {

void descriptor_bounds_sse41(const ShortForm* queries, const std::int16_t* candidates, std::size_t blocks,
                             std::int32_t* bounds, std::uint32_t* lead) noexcept {
  constexpr std::size_t kRegisters = kBoundLanes / 4, kPairs = kBoundNumbers / 2;
  const auto load = [](const void* at) { return _mm_loadu_si128(static_cast<const __m128i*>(at)); };
  const auto store = [](void* at, __m128i value) { _mm_storeu_si128(static_cast<__m128i*>(at), value); };
  for (std::size_t q = 0; q < kBoundQueries; ++q) {
    __m128i number[kPairs / 4];
    for (std::size_t k = 0; k < kPairs / 4; ++k) number[k] = load(queries[q].numbers + 8 * k);
    for (std::size_t r = 0; r < kRegisters; ++r) {
      __m128i most = _mm_set1_epi32(INT32_MIN);
      __m128i at = _mm_add_epi32(_mm_set1_epi32(static_cast<int>(4 * r)), _mm_setr_epi32(0, 1, 2, 3));
      __m128i best = at;
      for (std::size_t block = 0; block < blocks; ++block) {
        const std::int16_t* pairs = candidates + block * kBoundLanes * kBoundNumbers + 8 * r;
        __m128i sum = _mm_setzero_si128();
        for (std::size_t k = 0; k < kPairs / 4; ++k) {
          const std::int16_t* four = pairs + 8 * kBoundLanes * k;
          sum = _mm_add_epi32(sum, _mm_madd_epi16(load(four), _mm_shuffle_epi32(number[k], 0x00)));
          sum = _mm_add_epi32(
              sum, _mm_madd_epi16(load(four + 2 * kBoundLanes), _mm_shuffle_epi32(number[k], 0x55)));
          sum = _mm_add_epi32(
              sum, _mm_madd_epi16(load(four + 4 * kBoundLanes), _mm_shuffle_epi32(number[k], 0xAA)));
          sum = _mm_add_epi32(
              sum, _mm_madd_epi16(load(four + 6 * kBoundLanes), _mm_shuffle_epi32(number[k], 0xFF)));
        }
        store(bounds + (q * blocks + block) * kBoundLanes + 4 * r, sum);
        best = _mm_blendv_epi8(best, at, _mm_cmpgt_epi32(sum, most));
        most = _mm_max_epi32(most, sum);
        at = _mm_add_epi32(at, _mm_set1_epi32(kBoundLanes));
      }
      store(lead + q * kBoundLanes + 4 * r, best);
    }
  }
}

}  // namespace pliant

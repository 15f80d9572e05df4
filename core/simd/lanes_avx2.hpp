// Sixteen unsigned 16-bit lanes in AVX2; operations as in lanes_sse41.hpp.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace pliant {

struct LanesAvx2 {
  using Lanes = __m256i;
  static constexpr std::size_t kCount = 16;
  struct Band {
    Lanes low, high;
  };

  static Lanes load(const std::uint16_t* from) noexcept {
    return _mm256_loadu_si256(static_cast<const __m256i*>(static_cast<const void*>(from)));
  }
  static void store(std::uint16_t* to, Lanes a) noexcept {
    _mm256_storeu_si256(static_cast<__m256i*>(static_cast<void*>(to)), a);
  }
  static Lanes all(std::uint16_t x) noexcept { return _mm256_set1_epi16(static_cast<std::int16_t>(x)); }
  static Lanes zero() noexcept { return _mm256_setzero_si256(); }
  static Lanes add(Lanes a, Lanes b) noexcept { return _mm256_add_epi16(a, b); }
  static Lanes subtract(Lanes a, Lanes b) noexcept { return _mm256_sub_epi16(a, b); }
  static Lanes add_saturated(Lanes a, Lanes b) noexcept { return _mm256_adds_epu16(a, b); }
  static Lanes subtract_saturated(Lanes a, Lanes b) noexcept { return _mm256_subs_epu16(a, b); }
  static Lanes lesser(Lanes a, Lanes b) noexcept { return _mm256_min_epu16(a, b); }
  static Lanes both(Lanes a, Lanes b) noexcept { return _mm256_and_si256(a, b); }
  static Lanes distance(Lanes a, Lanes b) noexcept {
    return _mm256_or_si256(_mm256_subs_epu16(a, b), _mm256_subs_epu16(b, a));
  }
  static Lanes low_product(Lanes a, Lanes b) noexcept { return _mm256_mullo_epi16(a, b); }
  static Lanes high_product(Lanes a, Lanes b) noexcept { return _mm256_mulhi_epu16(a, b); }
  static Lanes rounded_product(Lanes a, Lanes b) noexcept { return _mm256_mulhrs_epi16(a, b); }
  static Lanes shift_left(Lanes a, int bits) noexcept { return _mm256_sll_epi16(a, _mm_cvtsi32_si128(bits)); }
  static Lanes at_most(Lanes a, Lanes b) noexcept { return _mm256_cmpeq_epi16(_mm256_min_epu16(a, b), a); }
  static Band band(Lanes z, Lanes limit) noexcept {
    return {_mm256_subs_epu16(z, limit), _mm256_adds_epu16(z, limit)};
  }
  static Lanes inside(Lanes a, const Band& b) noexcept {
    return _mm256_cmpeq_epi16(_mm256_min_epu16(_mm256_max_epu16(a, b.low), b.high), a);
  }
  static Lanes scale(Lanes a, std::uint16_t multiplier, std::uint32_t half, int shift) noexcept {
    const Lanes m = all(multiplier), low = _mm256_mullo_epi16(a, m), high = _mm256_mulhi_epu16(a, m);
    const Lanes h = _mm256_set1_epi32(static_cast<std::int32_t>(half));
    const __m128i s = _mm_cvtsi32_si128(shift);
    // unpacking and packing stay within the halves: the order is kept
    return _mm256_packus_epi32(_mm256_srl_epi32(_mm256_add_epi32(_mm256_unpacklo_epi16(low, high), h), s),
                               _mm256_srl_epi32(_mm256_add_epi32(_mm256_unpackhi_epi16(low, high), h), s));
  }
  static Lanes look_up(const std::uint16_t* table, Lanes a) noexcept {
    const Lanes bytes = _mm256_add_epi16(_mm256_mullo_epi16(a, all(0x0202)), all(0x0100));
    const __m128i eight = _mm_loadu_si128(static_cast<const __m128i*>(static_cast<const void*>(table)));
    return _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(eight), bytes);
  }
};

}  // namespace pliant

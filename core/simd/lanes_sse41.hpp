// Eight unsigned 16-bit lanes in SSE4.1. The operations of the lane types are the same in all of them; see
// camera/surface_rows_body.hpp for how they are used. Include only from files built for the instruction set.
#pragma once

#include <smmintrin.h>

#include <cstddef>
#include <cstdint>

namespace pliant {

struct LanesSse41 {
  using Lanes = __m128i;
  static constexpr std::size_t kCount = 8;
  /// For the test "within `limit` of `z`".
  struct Band {
    Lanes low, high;
  };

  static Lanes load(const std::uint16_t* from) noexcept {
    return _mm_loadu_si128(static_cast<const __m128i*>(static_cast<const void*>(from)));
  }
  static void store(std::uint16_t* to, Lanes a) noexcept {
    _mm_storeu_si128(static_cast<__m128i*>(static_cast<void*>(to)), a);
  }
  static Lanes all(std::uint16_t x) noexcept { return _mm_set1_epi16(static_cast<std::int16_t>(x)); }
  static Lanes zero() noexcept { return _mm_setzero_si128(); }
  static Lanes add(Lanes a, Lanes b) noexcept { return _mm_add_epi16(a, b); }
  static Lanes subtract(Lanes a, Lanes b) noexcept { return _mm_sub_epi16(a, b); }
  static Lanes add_saturated(Lanes a, Lanes b) noexcept { return _mm_adds_epu16(a, b); }
  static Lanes subtract_saturated(Lanes a, Lanes b) noexcept { return _mm_subs_epu16(a, b); }
  static Lanes lesser(Lanes a, Lanes b) noexcept { return _mm_min_epu16(a, b); }
  static Lanes both(Lanes a, Lanes b) noexcept { return _mm_and_si128(a, b); }
  static Lanes distance(Lanes a, Lanes b) noexcept {
    return _mm_or_si128(_mm_subs_epu16(a, b), _mm_subs_epu16(b, a));
  }
  static Lanes low_product(Lanes a, Lanes b) noexcept { return _mm_mullo_epi16(a, b); }
  static Lanes high_product(Lanes a, Lanes b) noexcept { return _mm_mulhi_epu16(a, b); }
  /// (2·a·b + 2^15) >> 16, signed.
  static Lanes rounded_product(Lanes a, Lanes b) noexcept { return _mm_mulhrs_epi16(a, b); }
  static Lanes shift_left(Lanes a, int bits) noexcept { return _mm_sll_epi16(a, _mm_cvtsi32_si128(bits)); }
  /// All ones where a <= b.
  static Lanes at_most(Lanes a, Lanes b) noexcept { return _mm_cmpeq_epi16(_mm_min_epu16(a, b), a); }
  static Band band(Lanes z, Lanes limit) noexcept {
    return {_mm_subs_epu16(z, limit), _mm_adds_epu16(z, limit)};
  }
  /// All ones where `a` lies in the band.
  static Lanes inside(Lanes a, const Band& b) noexcept {
    return _mm_cmpeq_epi16(_mm_min_epu16(_mm_max_epu16(a, b.low), b.high), a);
  }
  /// (a·multiplier + half) >> shift in 32 bits, which must fit 16.
  static Lanes scale(Lanes a, std::uint16_t multiplier, std::uint32_t half, int shift) noexcept {
    const Lanes m = all(multiplier), low = _mm_mullo_epi16(a, m), high = _mm_mulhi_epu16(a, m);
    const Lanes h = _mm_set1_epi32(static_cast<std::int32_t>(half)), s = _mm_cvtsi32_si128(shift);
    return _mm_packus_epi32(_mm_srl_epi32(_mm_add_epi32(_mm_unpacklo_epi16(low, high), h), s),
                            _mm_srl_epi32(_mm_add_epi32(_mm_unpackhi_epi16(low, high), h), s));
  }
  /// table[a] for a < 8; 0 for a = 2^16 - 1.
  static Lanes look_up(const std::uint16_t* table, Lanes a) noexcept {
    const Lanes bytes = _mm_add_epi16(_mm_mullo_epi16(a, all(0x0202)), all(0x0100));
    return _mm_shuffle_epi8(load(table), bytes);
  }
};

}  // namespace pliant

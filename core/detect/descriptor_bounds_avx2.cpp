// Eight candidates an instruction (vpmaddwd), 32-bit sums.
#include <immintrin.h>

#include <cstring>

#include "core/detect/descriptor_bounds.hpp"

namespace pliant {

void descriptor_bounds_avx2(const ShortForm* queries, const std::int16_t* candidates, std::size_t blocks,
                            std::int32_t* bounds, std::uint32_t* lead) noexcept {
  constexpr std::size_t kPairs = kBoundNumbers / 2;
  const auto load = [](const void* at) { return _mm256_loadu_si256(static_cast<const __m256i*>(at)); };
  const auto store = [](void* at, __m256i value) { _mm256_storeu_si256(static_cast<__m256i*>(at), value); };
  std::int32_t pair[kBoundQueries][kPairs];
  std::memcpy(pair, queries, sizeof pair);
  for (std::size_t half = 0; half < 2; ++half) {
    __m256i at = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(8 * half)),
                                  _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    __m256i most[kBoundQueries], best[kBoundQueries];
    for (std::size_t q = 0; q < kBoundQueries; ++q) {
      most[q] = _mm256_set1_epi32(INT32_MIN);
      best[q] = at;
    }
    for (std::size_t block = 0; block < blocks; ++block) {
      const std::int16_t* pairs = candidates + block * kBoundLanes * kBoundNumbers + 16 * half;
      __m256i sum[kBoundQueries] = {_mm256_setzero_si256(), _mm256_setzero_si256(), _mm256_setzero_si256(),
                                    _mm256_setzero_si256()};
      for (std::size_t k = 0; k < kPairs; ++k) {
        const __m256i candidate = load(pairs + 2 * kBoundLanes * k);
        for (std::size_t q = 0; q < kBoundQueries; ++q)
          sum[q] = _mm256_add_epi32(sum[q], _mm256_madd_epi16(candidate, _mm256_set1_epi32(pair[q][k])));
      }
      for (std::size_t q = 0; q < kBoundQueries; ++q) {
        store(bounds + (q * blocks + block) * kBoundLanes + 8 * half, sum[q]);
        best[q] = _mm256_blendv_epi8(best[q], at, _mm256_cmpgt_epi32(sum[q], most[q]));
        most[q] = _mm256_max_epi32(most[q], sum[q]);
      }
      at = _mm256_add_epi32(at, _mm256_set1_epi32(kBoundLanes));
    }
    for (std::size_t q = 0; q < kBoundQueries; ++q) store(lead + q * kBoundLanes + 8 * half, best[q]);
  }
}

std::size_t select_bounds_avx2(const std::int32_t* bounds, std::size_t count, std::int32_t least,
                               std::uint32_t* out) noexcept {
  // INT32_MIN never stands here: least − 1 does not wrap.
  const __m256i below = _mm256_set1_epi32(least - 1);
  std::size_t left = 0, c = 0;
  for (; c + 8 <= count; c += 8) {
    const __m256i eight =
        _mm256_loadu_si256(static_cast<const __m256i*>(static_cast<const void*>(bounds + c)));
    auto mask =
        static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(eight, below))));
    for (; mask != 0; mask &= mask - 1)
      out[left++] = static_cast<std::uint32_t>(c) + static_cast<std::uint32_t>(__builtin_ctz(mask));
  }
  for (; c < count; ++c) {
    out[left] = static_cast<std::uint32_t>(c);
    left += bounds[c] >= least ? 1U : 0U;
  }
  return left;
}

void project_descriptor_avx2(const Descriptor& descriptor, const float* basis, float* along) noexcept {
  constexpr std::size_t kRegisters = kBoundNumbers / 8;
  __m256 sum[kRegisters];
  for (__m256& s : sum) s = _mm256_setzero_ps();
  for (std::size_t i = 0; i < kDescriptorSize; ++i) {
    const __m256 bin = _mm256_set1_ps(static_cast<float>(descriptor.bins[i]));
    for (std::size_t r = 0; r < kRegisters; ++r)
      sum[r] = _mm256_add_ps(sum[r], _mm256_mul_ps(bin, _mm256_loadu_ps(basis + i * kBoundNumbers + 8 * r)));
  }
  for (std::size_t r = 0; r < kRegisters; ++r) _mm256_storeu_ps(along + 8 * r, sum[r]);
}

}  // namespace pliant

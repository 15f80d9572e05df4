// Four 64-bit sums in a vector: the first four rows of the matrix, a column a vector, and what is left.
#include <immintrin.h>

#include "core/fixed/moment_rows.hpp"

namespace pliant {

namespace {

__m256i widened(const std::int32_t* from) noexcept {
  return _mm256_cvtepi32_epi64(_mm_loadu_si128(static_cast<const __m128i*>(static_cast<const void*>(from))));
}

void add_products(__m256i& sum, __m256i a, __m256i b) noexcept {
  sum = _mm256_add_epi64(sum, _mm256_mul_epi32(a, b));
}

std::array<std::int64_t, 4> lanes_of(__m256i v) noexcept {
  std::array<std::int64_t, 4> out;
  _mm256_storeu_si256(static_cast<__m256i*>(static_cast<void*>(out.data())), v);
  return out;
}

}  // namespace

void add_moment_rows_avx2(const MomentRow* rows, std::size_t count, PlaneMoments& moments) noexcept {
  const __m256i none = _mm256_setzero_si256();
  __m256i column0 = none, column1 = none, column2 = none, column3 = none, column4 = none, column5 = none;
  __m256i residuals = none;                               // times the weighted j[0 … 3]
  __m256i rest4 = none, rest5 = none, rest_right = none;  // the weighted (j4 j5 residual weight) times each
  __m256i plain = none;                                   // j4 j5 residual weight
  for (std::size_t k = 0; k < count; ++k) {
    const MomentRow& row = rows[k];
    const __m256i w = _mm256_set1_epi32(row.weight), r = _mm256_set1_epi32(row.residual);
    const __m256i j4 = _mm256_set1_epi32(row.j[4]), j5 = _mm256_set1_epi32(row.j[5]);
    const __m256i last = widened(&row.j[4]);
    const __m256i first = _mm256_mul_epi32(widened(row.j.data()), w), rest = _mm256_mul_epi32(last, w);
    add_products(column0, first, _mm256_set1_epi32(row.j[0]));
    add_products(column1, first, _mm256_set1_epi32(row.j[1]));
    add_products(column2, first, _mm256_set1_epi32(row.j[2]));
    add_products(column3, first, _mm256_set1_epi32(row.j[3]));
    add_products(column4, first, j4);
    add_products(column5, first, j5);
    add_products(residuals, first, r);
    add_products(rest4, rest, j4);
    add_products(rest5, rest, j5);
    add_products(rest_right, rest, r);
    plain = _mm256_add_epi64(plain, last);
  }
  const std::array<std::array<std::int64_t, 4>, 6> columns = {lanes_of(column0), lanes_of(column1),
                                                              lanes_of(column2), lanes_of(column3),
                                                              lanes_of(column4), lanes_of(column5)};
  std::size_t at = 0;
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = row; column < 6; ++column) moments.a[at++] += columns[column][row];
  const auto with4 = lanes_of(rest4), with5 = lanes_of(rest5), with_residual = lanes_of(rest_right);
  moments.a[18] += with4[0];
  moments.a[19] += with5[0];
  moments.a[20] += with5[1];
  const auto right = lanes_of(residuals);
  for (std::size_t row = 0; row < 4; ++row) moments.b[row] += right[row];
  moments.b[4] += with_residual[0];
  moments.b[5] += with_residual[1];
  moments.square += with_residual[2];
  moments.weight += lanes_of(plain)[3];
  moments.rows += static_cast<std::uint32_t>(count);
}

}  // namespace pliant

// Sums of a point-to-plane least-squares problem, exact in 64 bits: the order of adding cannot change them.
#pragma once

#include <array>
#include <cstdint>

namespace pliant {

/// Normal equations of  n·(q − p) = (c × n)·ω + n·t  over weighted rows (c = p − centre).
/// Formats: moment arms c × n in 1/16 mm, normals Q14, residuals 1/256 mm, weights Q8 (256 = 1).
/// Overflow bound: |arm| < 2^16, |normal| <= 2^14, |residual| < 2^18, weight <= 2^8, so that a term stays
/// below 2^(8 + 16 + 18) = 2^42 and 2^14 of them (limits::kMaxModelPoints) below 2^56.
struct PlaneMoments {
  std::array<std::int64_t, 21>
      a{};  ///< upper triangle of the 6×6 matrix, row by row (arms first, then normals)
  std::array<std::int64_t, 6> b{};
  std::int64_t weight = 0;  ///< Q8
  std::int64_t square = 0;  ///< weighted residuals squared, 1/256 mm squared, Q8
  std::uint32_t rows = 0;

  /// `j`: the arm's three components, then the normal's.
  void add(const std::array<std::int32_t, 6>& j, std::int32_t residual, std::int32_t w) noexcept {
    std::size_t k = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      const std::int64_t wj = static_cast<std::int64_t>(w) * j[row];
      for (std::size_t column = row; column < 6; ++column) a[k++] += wj * j[column];
      b[row] += wj * residual;
    }
    weight += w;
    square += static_cast<std::int64_t>(w) * residual * residual;
    ++rows;
  }
  /// The rows of `other`, too.
  void add(const PlaneMoments& other) noexcept {
    for (std::size_t k = 0; k < a.size(); ++k) a[k] += other.a[k];
    for (std::size_t k = 0; k < b.size(); ++k) b[k] += other.b[k];
    weight += other.weight;
    square += other.square;
    rows += other.rows;
  }
};

/// Tukey's weight (1 − (r/c)²)² in Q8; both in the same unit, |r| < 2^22, 0 < c < 2^22.
[[nodiscard]] constexpr std::int32_t tukey_weight(std::int32_t residual, std::int32_t limit) noexcept {
  const std::int32_t size = residual < 0 ? -residual : residual;
  if (size >= limit) return 0;
  const std::int32_t ratio = (size << 8) / limit;   // Q8, below 256
  const std::int32_t rest = 65536 - ratio * ratio;  // Q16
  return ((rest >> 8) * (rest >> 8)) >> 8;
}

}  // namespace pliant

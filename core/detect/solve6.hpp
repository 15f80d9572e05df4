// Six normal equations of a small rigid motion.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// Sums of w · row · rowᵀ and w · row · residual over point-to-plane rows (three of the turn, three of the
/// shift).
class NormalEquations6 {
 public:
  NormalEquations6() noexcept = default;
  /// From sums taken elsewhere: the matrix's lower triangle row by row, the right side, the weights.
  NormalEquations6(const std::array<float, 21>& a, const std::array<float, 6>& b, float weight) noexcept
      : weight_(static_cast<double>(weight)) {
    for (std::size_t k = 0; k < 21; ++k) a_[k] = static_cast<double>(a[k]);
    for (std::size_t k = 0; k < 6; ++k) b_[k] = static_cast<double>(b[k]);
  }

  void add(const double (&row)[6], double residual, double weight) noexcept {
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      const double scaled = weight * row[i];
      for (int j = 0; j <= i; ++j) a_[k++] += scaled * row[j];
      b_[i] += scaled * residual;
    }
    weight_ += weight;
  }
  [[nodiscard]] double weight() const noexcept { return weight_; }

  /// Solves with Tikhonov damping: `turn_damping` (m²) and `shift_damping` (1) per unit of summed weight.
  /// False when the equations are singular all the same.
  [[nodiscard]] bool solve(double turn_damping, double shift_damping, Vector3& turn,
                           Vector3& shift) const noexcept;

 private:
  double a_[21] = {};  // lower triangle, row by row
  double b_[6] = {};
  double weight_ = 0;
};

}  // namespace pliant

// Symmetric 6×6 matrices of small rigid motions, and their Cholesky factors.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/vector6.hpp"

namespace pliant {

/// Lower triangle, row by row.
struct Symmetric6 {
  std::array<double, 21> a{};

  [[nodiscard]] static constexpr std::size_t index(std::size_t row, std::size_t column) noexcept {
    return row * (row + 1) / 2 + column;
  }
  [[nodiscard]] double& at(std::size_t row, std::size_t column) noexcept { return a[index(row, column)]; }

  /// A spring of stiffness `k` that holds the point at `arm` from the centre.
  void add_point_spring(double k, const Vector3& arm) noexcept {
    const double x = k * arm.x(), y = k * arm.y(), z = k * arm.z();
    at(0, 0) += y * arm.y() + z * arm.z();
    at(1, 0) -= x * arm.y();
    at(1, 1) += x * arm.x() + z * arm.z();
    at(2, 0) -= x * arm.z();
    at(2, 1) -= y * arm.z();
    at(2, 2) += x * arm.x() + y * arm.y();
    at(3, 1) += z;
    at(3, 2) -= y;
    at(4, 0) -= z;
    at(4, 2) += x;
    at(5, 0) += y;
    at(5, 1) -= x;
    for (std::size_t i = 3; i < 6; ++i) at(i, i) += k;
  }
  void add_turn_spring(double k) noexcept {
    for (std::size_t i = 0; i < 3; ++i) at(i, i) += k;
  }
  void add_shift_spring(double k) noexcept {
    for (std::size_t i = 3; i < 6; ++i) at(i, i) += k;
  }

  [[nodiscard]] Vector6 operator*(const Vector6& x) const noexcept {
    Vector6 y;
    const double* m = a.data();
    const double x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3], x4 = x[4], x5 = x[5];
    y[0] = m[0] * x0 + m[1] * x1 + m[3] * x2 + m[6] * x3 + m[10] * x4 + m[15] * x5;
    y[1] = m[1] * x0 + m[2] * x1 + m[4] * x2 + m[7] * x3 + m[11] * x4 + m[16] * x5;
    y[2] = m[3] * x0 + m[4] * x1 + m[5] * x2 + m[8] * x3 + m[12] * x4 + m[17] * x5;
    y[3] = m[6] * x0 + m[7] * x1 + m[8] * x2 + m[9] * x3 + m[13] * x4 + m[18] * x5;
    y[4] = m[10] * x0 + m[11] * x1 + m[12] * x2 + m[13] * x3 + m[14] * x4 + m[19] * x5;
    y[5] = m[15] * x0 + m[16] * x1 + m[17] * x2 + m[18] * x3 + m[19] * x4 + m[20] * x5;
    return y;
  }
};

/// L·D·Lᵀ of a positive definite matrix.
struct Factor6 {
  std::array<double, 15> lower{};  ///< below the unit diagonal, row by row
  std::array<double, 6> inverse{};

  /// False when the matrix is not positive definite.
  [[nodiscard]] bool factorise(const Symmetric6& m) noexcept {
    std::array<double, 6> d{};
    for (std::size_t i = 0; i < 6; ++i) {
      double* row = &lower[i > 0 ? i * (i - 1) / 2 : 0];
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = m.a[Symmetric6::index(i, j)];
        const double* other = &lower[j > 0 ? j * (j - 1) / 2 : 0];
        for (std::size_t k = 0; k < j; ++k) sum -= row[k] * (i == j ? row[k] : other[k]) * d[k];
        if (i == j) {
          if (!(sum > 0)) return false;
          d[i] = sum;
          inverse[i] = 1 / sum;
        } else {
          row[j] = sum * inverse[j];
        }
      }
    }
    return true;
  }
  /// Place of an element in `lower`.
  [[nodiscard]] static constexpr std::size_t below_diagonal(int row, int column) noexcept {
    const auto r = static_cast<std::size_t>(row);
    return r * (r - 1) / 2 + static_cast<std::size_t>(column);
  }
  [[nodiscard]] Vector6 solve(const Vector6& b) const noexcept {
    Vector6 x = b;
    for (int i = 1; i < 6; ++i)
      for (int k = 0; k < i; ++k) x[i] -= lower[below_diagonal(i, k)] * x[k];
    for (int i = 0; i < 6; ++i) x[i] *= inverse[static_cast<std::size_t>(i)];
    for (int i = 4; i >= 0; --i)
      for (int k = i + 1; k < 6; ++k) x[i] -= lower[below_diagonal(k, i)] * x[k];
    return x;
  }
};

}  // namespace pliant

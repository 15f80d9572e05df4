// The quadric nearest to points: ball, ellipsoid, tube, cone, plane.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// Least mean squared distance, to first order (Taubin: Estimation of planar curves, surfaces, and nonplanar
/// space curves defined by implicit equations, PAMI 1991). For points with coordinates of about one.
class QuadricFit {
 public:
  void add(const Vector3& p) noexcept;
  /// After all points; false when there is no answer.
  [[nodiscard]] bool solve() noexcept;
  /// Of a point from the quadric, to first order, at most `most`.
  [[nodiscard]] double squared_distance(const Vector3& p, double most) const noexcept;

 private:
  static constexpr std::size_t kTerms = 10;
  using Terms = std::array<double, kTerms>;
  using Square = std::array<Terms, kTerms>;

  static Terms values_at(const Vector3& p) noexcept;
  static std::array<Terms, 3> slopes_at(const Vector3& p) noexcept;
  static bool factorise(Square& a) noexcept;
  static Terms solved(const Square& factor, const Terms& right) noexcept;

  Square values_{}, slopes_{};  // lower triangles of the sums
  Terms quadric_{};
};

}  // namespace pliant

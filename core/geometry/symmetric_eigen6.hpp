// Eigenvalues of small rigid motions' matrices.
#pragma once

#include "core/geometry/vector6.hpp"

namespace pliant {

struct Eigen6 {
  Vector6 values;   ///< ascending
  Matrix6 vectors;  ///< columns, orthonormal
};

/// Of a symmetric matrix, by a fixed number of sweeps of Jacobi's rotations: the same bits everywhere.
[[nodiscard]] Eigen6 symmetric_eigen6(Matrix6 m) noexcept;

}  // namespace pliant

// Eigenvectors of a symmetric 3×3 matrix by Jacobi rotations: only + − × ÷ and sqrt, a fixed number of
// sweeps.
#pragma once

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

struct SymmetricEigen {
  Vector3 values;   ///< ascending
  Matrix3 vectors;  ///< columns, unit, right-handed or not
};

/// `m` is read as symmetric. Off-diagonals fall below 1e-12 of the trace within the fixed six sweeps.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Matrix3& m) noexcept;

}  // namespace pliant

#include "core/detect/solve6.hpp"

namespace pliant {

bool NormalEquations6::solve(double turn_damping, double shift_damping, Vector3& turn,
                             Vector3& shift) const noexcept {
  // LDLᵀ without pivoting: the matrix is symmetric and, damped, positive definite.
  double l[6][6] = {};
  double d[6] = {};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = a_[i * (i + 1) / 2 + j];
      if (i == j) sum += weight_ * (i < 3 ? turn_damping : shift_damping);
      for (int k = 0; k < j; ++k) sum -= l[i][k] * l[j][k] * d[k];
      if (i == j) {
        if (!(sum > 0)) return false;
        d[i] = sum;
        l[i][i] = 1;
      } else {
        l[i][j] = sum / d[j];
      }
    }
  }
  double x[6];
  for (int i = 0; i < 6; ++i) {
    x[i] = b_[i];
    for (int k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
  }
  for (int i = 0; i < 6; ++i) x[i] /= d[i];
  for (int i = 5; i >= 0; --i)
    for (int k = i + 1; k < 6; ++k) x[i] -= l[k][i] * x[k];
  turn = Vector3(x[0], x[1], x[2]);
  shift = Vector3(x[3], x[4], x[5]);
  return true;
}

}  // namespace pliant

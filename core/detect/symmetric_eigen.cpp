#include "core/detect/symmetric_eigen.hpp"

#include <cmath>

namespace pliant {

namespace {

/// Turns rows and columns p and q of `a` so that a(p, q) becomes zero; gathers the turn in `v`.
void rotate(Matrix3& a, Matrix3& v, int p, int q) noexcept {
  if (a(p, q) == 0) return;
  const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
  const double t = (theta < 0 ? -1.0 : 1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  const int r = 3 - p - q;
  const double apq = a(p, q), arp = a(r, p), arq = a(r, q);
  a(p, p) -= t * apq;
  a(q, q) += t * apq;
  a(p, q) = a(q, p) = 0;
  a(r, p) = a(p, r) = c * arp - s * arq;
  a(r, q) = a(q, r) = s * arp + c * arq;
  for (int i = 0; i < 3; ++i) {
    const double vip = v(i, p), viq = v(i, q);
    v(i, p) = c * vip - s * viq;
    v(i, q) = s * vip + c * viq;
  }
}

}  // namespace

SymmetricEigen symmetric_eigen(const Matrix3& m) noexcept {
  Matrix3 a = m;
  Matrix3 v = Matrix3::Identity();
  const double small = 1e-12 * (std::fabs(a(0, 0)) + std::fabs(a(1, 1)) + std::fabs(a(2, 2)));
  for (int sweep = 0; sweep < 6; ++sweep) {
    if (std::fabs(a(0, 1)) + std::fabs(a(0, 2)) + std::fabs(a(1, 2)) <= small) break;
    rotate(a, v, 0, 1);
    rotate(a, v, 0, 2);
    rotate(a, v, 1, 2);
  }
  int order[3] = {0, 1, 2};
  const auto swap_if = [&](int i, int j) {
    if (a(order[j], order[j]) < a(order[i], order[i])) {
      const int k = order[i];
      order[i] = order[j];
      order[j] = k;
    }
  };
  swap_if(0, 1);
  swap_if(1, 2);
  swap_if(0, 1);
  SymmetricEigen result;
  for (int i = 0; i < 3; ++i) {
    result.values(i) = a(order[i], order[i]);
    for (int k = 0; k < 3; ++k) result.vectors(k, i) = v(k, order[i]);
  }
  return result;
}

}  // namespace pliant

#include "core/geometry/symmetric_eigen6.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pliant {

Eigen6 symmetric_eigen6(Matrix6 m) noexcept {
  constexpr int kSweeps = 12;
  Matrix6 vectors = Matrix6::Identity();
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int p = 0; p < 5; ++p)
      for (int q = p + 1; q < 6; ++q) {
        if (m(p, q) == 0) continue;
        const double half = 0.5 * (m(q, q) - m(p, p)) / m(p, q);
        const double t = (half < 0 ? -1 : 1) / (std::fabs(half) + std::sqrt(half * half + 1));
        if (!std::isfinite(t)) continue;
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        const auto turn = [c, s](double& a, double& b) {
          const double before = a;
          a = c * before - s * b;
          b = s * before + c * b;
        };
        for (int k = 0; k < 6; ++k) turn(m(k, p), m(k, q));
        for (int k = 0; k < 6; ++k) turn(m(p, k), m(q, k));
        for (int k = 0; k < 6; ++k) turn(vectors(k, p), vectors(k, q));
      }
  std::array<int, 6> order = {0, 1, 2, 3, 4, 5};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return m(a, a) != m(b, b) ? m(a, a) < m(b, b) : a < b; });
  Eigen6 result;
  for (int k = 0; k < 6; ++k) {
    const int from = order[static_cast<std::size_t>(k)];
    result.values(k) = m(from, from);
    result.vectors.col(k) = vectors.col(from);
  }
  return result;
}

}  // namespace pliant

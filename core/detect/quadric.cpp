#include "core/detect/quadric.hpp"

#include <cmath>

namespace pliant {

namespace {

constexpr int kRounds = 12;       // of inverse iteration; noise parts the least eigenvalue from the others
constexpr double kRidge = 1e-10;  // of the mean eigenvalue: many quadrics hold a plane, any will do

template <typename Terms>
double product(const Terms& a, const Terms& b) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

template <typename Terms, typename Square>
void add_square(const Terms& t, Square& sum) noexcept {
  for (std::size_t i = 0; i < t.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) sum[i][j] += t[i] * t[j];
}

}  // namespace

QuadricFit::Terms QuadricFit::values_at(const Vector3& p) noexcept {
  const double x = p.x(), y = p.y(), z = p.z();
  return {x * x, y * y, z * z, x * y, x * z, y * z, x, y, z, 1};
}

std::array<QuadricFit::Terms, 3> QuadricFit::slopes_at(const Vector3& p) noexcept {
  const double x = p.x(), y = p.y(), z = p.z();
  return {{{2 * x, 0, 0, y, z, 0, 1, 0, 0, 0},
           {0, 2 * y, 0, x, 0, z, 0, 1, 0, 0},
           {0, 0, 2 * z, 0, x, y, 0, 0, 1, 0}}};
}

void QuadricFit::add(const Vector3& p) noexcept {
  add_square(values_at(p), values_);
  for (const Terms& along : slopes_at(p)) add_square(along, slopes_);
}

/// The lower triangle's Cholesky factor in its place; false when the matrix is not positive.
bool QuadricFit::factorise(Square& a) noexcept {
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = a[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= a[i][k] * a[j][k];
      if (i != j) {
        a[i][j] = rest / a[j][j];
      } else if (rest > 0) {
        a[i][i] = std::sqrt(rest);
      } else {
        return false;
      }
    }
  return true;
}

QuadricFit::Terms QuadricFit::solved(const Square& factor, const Terms& right) noexcept {
  Terms x = right;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= factor[i][k] * x[k];
    x[i] /= factor[i][i];
  }
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t k = i + 1; k < kTerms; ++k) x[i] -= factor[k][i] * x[k];
    x[i] /= factor[i][i];
  }
  return x;
}

bool QuadricFit::solve() noexcept {
  double trace = 0;
  for (std::size_t i = 0; i < kTerms; ++i) trace += values_[i][i];
  for (std::size_t i = 0; i < kTerms; ++i) {
    values_[i][i] += kRidge * trace / kTerms;
    for (std::size_t j = 0; j < i; ++j) slopes_[j][i] = slopes_[i][j];
  }
  if (!factorise(values_)) return false;
  quadric_ = {1, 1.1, 1.2, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, -1};  // a part of every solution
  for (int round = 0; round < kRounds; ++round) {
    Terms right{};
    for (std::size_t i = 0; i < kTerms; ++i) right[i] = product(slopes_[i], quadric_);
    quadric_ = solved(values_, right);
    const double length = std::sqrt(product(quadric_, quadric_));
    if (!(length > 0 && length < 1e300)) return false;  // also for not-a-number
    for (double& q : quadric_) q /= length;
  }
  return true;
}

double QuadricFit::squared_distance(const Vector3& p, double most) const noexcept {
  const double value = product(values_at(p), quadric_);
  double steepness = 0;
  for (const Terms& along : slopes_at(p)) {
    const double slope = product(along, quadric_);
    steepness += slope * slope;
  }
  return value * value < most * most * steepness ? value * value / steepness : most * most;
}

}  // namespace pliant

#include "drivers/simulated/implicit.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::simulated {

namespace {
double length(const Vector3& v) {
  return std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z());
}
}  // namespace

double sphere(const Vector3& p, const Vector3& centre, double radius) {
  return length(p - centre) - radius;
}

double capsule(const Vector3& p, const Vector3& a, const Vector3& b, double radius) {
  const Vector3 ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.dot(ab), 0.0, 1.0);
  return length(p - a - t * ab) - radius;
}

double rounded_box(const Vector3& p, const Vector3& centre, const Vector3& half, double radius) {
  const Vector3 q = (p - centre).cwiseAbs() - half + Vector3::Constant(radius);
  return length(q.cwiseMax(0.0)) + std::min(q.maxCoeff(), 0.0) - radius;
}

double ellipsoid(const Vector3& p, const Vector3& centre, const Vector3& radii) {
  const Vector3 q = (p - centre).cwiseQuotient(radii);
  const double scaled = length(q);
  const double gradient = length(q.cwiseQuotient(radii));
  return gradient > 0 ? scaled * (scaled - 1) / gradient : -radii.minCoeff();
}

double pillow(const Vector3& p, const Vector3& half) {
  const Vector3 q = p.cwiseQuotient(half);
  const double x3 = q.x() * q.x() * q.x();
  const double y3 = q.y() * q.y() * q.y();
  const double f = x3 * q.x() + y3 * q.y() + q.z() * q.z() - 1;
  const Vector3 gradient(4 * x3 / half.x(), 4 * y3 / half.y(), 2 * q.z() / half.z());
  return f / std::max(length(gradient), 1 / half.maxCoeff());
}

double half_space(const Vector3& p, const Vector3& point, const Vector3& normal) {
  return (p - point).dot(normal);
}

double smooth_union(double a, double b, double blend) {
  const double h = std::max(blend - std::fabs(a - b), 0.0) / blend;
  return std::min(a, b) - h * h * blend * 0.25;
}

double smooth_difference(double a, double b, double blend) {
  return -smooth_union(-a, b, blend);
}

}  // namespace pliant::simulated

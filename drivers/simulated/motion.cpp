#include "drivers/simulated/motion.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::simulated {

namespace {
constexpr double kTwoPi = 6.283185307179586476925;
}

double sine(double turns) {
  turns -= std::floor(turns + 0.5);  // [-0.5, 0.5)
  if (turns > 0.25) turns = 0.5 - turns;
  if (turns < -0.25) turns = -0.5 - turns;
  const double x = kTwoPi * turns;  // [-pi/2, pi/2]: Taylor's series to x^17
  const double y = x * x;
  double sum = 1;
  for (int n = 16; n >= 2; n -= 2) sum = 1 - y / (n * (n + 1)) * sum;
  return x * sum;
}

double cosine(double turns) {
  return sine(turns + 0.25);
}

Matrix3 rotation_about(const Vector3& axis, double turns) {
  const double s = sine(turns);
  const double c = cosine(turns);
  Matrix3 cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Matrix3::Identity() * c + cross * s + axis * axis.transpose() * (1 - c);
}

RigidTransform hinge(const Vector3& point, const Vector3& axis, double turns) {
  const Matrix3 rotation = rotation_about(axis, turns);
  return {rotation, point - rotation * point};
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double glide(double phase, double from, double to) {
  constexpr double kEase = 0.125;
  constexpr double kSpeed = 1 / (1 - kEase);
  const double t = std::clamp((phase - from) / (to - from), 0.0, 1.0);
  if (t < kEase) return kSpeed * t * t / (2 * kEase);
  if (t > 1 - kEase) return 1 - kSpeed * (1 - t) * (1 - t) / (2 * kEase);
  return kSpeed * (t - kEase / 2);
}

double there_and_back(double phase, double from, double full, double fall, double to) {
  return glide(phase, from, full) - glide(phase, fall, to);
}

double sway(double phase, double period, int cycles) {
  return 0.5 * (1 - cosine(phase / period * cycles));
}

}  // namespace pliant::simulated

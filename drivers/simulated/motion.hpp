// Angles, rotations and gentle motions without the mathematical library: the same bits on every platform.
#pragma once

#include "core/geometry/rigid_transform.hpp"

namespace pliant::simulated {

inline constexpr double kDegree = 1.0 / 360.0;  ///< turns

/// Sine and cosine of an angle in turns, |turns| < 10^6; error below 10^-12.
[[nodiscard]] double sine(double turns);
[[nodiscard]] double cosine(double turns);
/// Rotation about the unit vector `axis` by `turns`.
[[nodiscard]] Matrix3 rotation_about(const Vector3& axis, double turns);
/// Rotation by `turns` about the line through `point` along the unit vector `axis`.
[[nodiscard]] RigidTransform hinge(const Vector3& point, const Vector3& axis, double turns);

/// 0 below t = 0, 1 above t = 1, smooth between; steepest slope 1.5.
[[nodiscard]] double smooth_step(double t);
/// From 0 to 1 while `phase` goes from `from` to `to`: speeds up over the first eighth, slows down over the
/// last, at constant speed (8/7 of the mean) between.
[[nodiscard]] double glide(double phase, double from, double to);
/// Rises over [from, full], stays 1 until `fall`, is 0 again at `to`.
[[nodiscard]] double there_and_back(double phase, double from, double full, double fall, double to);
/// `cycles` smooth excursions from 0 to 1 and back while `phase` goes from 0 to `period`.
[[nodiscard]] double sway(double phase, double period, int cycles);

}  // namespace pliant::simulated

#include "core/registration/cloud_align.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/fast_transform.hpp"
#include "core/detect/solve6.hpp"

namespace pliant {

namespace {

float alike(const Point3f& n, const Normal16& m) noexcept {
  return (n.x * static_cast<float>(m.x) + n.y * static_cast<float>(m.y) + n.z * static_cast<float>(m.z)) *
         (1.0F / 16384);
}

/// The nearest usable target point within `reach` of p.
std::uint32_t nearest_of(const CloudTarget& target, const Point3f& p, float reach) noexcept {
  float square = 0;
  if (target.taken.empty()) return target.grid->nearest(p, reach, square);
  return target.grid->nearest_if(p, reach, square, [&](std::uint32_t i) { return target.taken[i] == 0; });
}

}  // namespace

std::size_t align_to_cloud(const ModelView& model, std::span<const std::uint16_t> which,
                           const CloudTarget& target, const AlignSettings& settings,
                           RigidTransform& pose) noexcept {
  std::size_t held = 0;
  for (int iteration = 0; iteration < settings.iterations; ++iteration) {
    const FastTransform fast(pose);
    const Vector3 pivot = pose * model.centre();
    const Point3f about = to_point(pivot);
    const double share =
        settings.iterations > 1 ? static_cast<double>(iteration) / (settings.iterations - 1) : 1;
    const auto gate =
        static_cast<float>(settings.first_gate + (settings.last_gate - settings.first_gate) * share);
    const float reach = std::sqrt(gate * gate + static_cast<float>(settings.reach * settings.reach));
    NormalEquations6 equations;
    held = 0;
    for (const std::uint16_t i : which) {
      const Point3f p = fast.point(model.positions()[i]);
      const std::uint32_t j = nearest_of(target, p, reach);
      if (j == PointGrid::kNone) continue;
      const Point3f n = fast.direction(model.normals()[i]);
      if (!target.normals.empty() && alike(n, target.normals[j]) < 0.7071F) continue;
      const Point3f& q = target.points[j];
      const float residual = n.x * (q.x - p.x) + n.y * (q.y - p.y) + n.z * (q.z - p.z);
      if (std::fabs(residual) >= gate) continue;
      const float ratio = residual / gate;
      const float w = (1 - ratio * ratio) * (1 - ratio * ratio);
      const Point3f a = {p.x - about.x, p.y - about.y, p.z - about.z};
      const double row[6] = {static_cast<double>(a.y * n.z - a.z * n.y),
                             static_cast<double>(a.z * n.x - a.x * n.z),
                             static_cast<double>(a.x * n.y - a.y * n.x),
                             static_cast<double>(n.x),
                             static_cast<double>(n.y),
                             static_cast<double>(n.z)};
      equations.add(row, static_cast<double>(residual), static_cast<double>(w));
      ++held;
    }
    if (held < 6) return 0;
    Vector3 turn, shift;
    if (!equations.solve(1e-6 * model.radius() * model.radius(), 1e-6, turn, shift)) return 0;
    const Matrix3 rotation = rotation_from_small_vector(turn);
    pose.rotation = orthonormalised(rotation * pose.rotation);
    pose.translation = rotation * (pose.translation - pivot) + pivot + shift;
  }
  return held;
}

double cloud_agreement(const ModelView& model, std::span<const std::uint16_t> which,
                       const CloudTarget& target, const RigidTransform& pose, double tolerance,
                       double reach) noexcept {
  const FastTransform fast(pose);
  const auto limit = static_cast<float>(tolerance);
  double sum = 0;
  for (const std::uint16_t i : which) {
    const Point3f p = fast.point(model.positions()[i]);
    const std::uint32_t j = nearest_of(target, p, static_cast<float>(reach));
    if (j == PointGrid::kNone) continue;
    const Point3f n = fast.direction(model.normals()[i]);
    const Point3f& q = target.points[j];
    const float residual = n.x * (q.x - p.x) + n.y * (q.y - p.y) + n.z * (q.z - p.z);
    if (std::fabs(residual) >= limit) continue;
    const float ratio = residual / limit;
    const float same = std::clamp((alike(n, target.normals[j]) - 0.5F) * 2.5F, 0.0F, 1.0F);
    sum += static_cast<double>(same * (1 - ratio * ratio));
  }
  return sum;
}

}  // namespace pliant

#include "core/detect/pose_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/fast_transform.hpp"
#include "core/detect/solve6.hpp"

namespace pliant {

namespace {

constexpr float kFacing = 0.1736F * 0.1736F;  // cos² 80°
constexpr float kSameNormal = 0.7071F;        // cos 45°
constexpr double kResolvable = 0.06;  // of the model's radius; noise (3 σ) wider than that hides relief
constexpr double kFarInFront = 0.2;   // of the model's radius: no dent is that deep
constexpr float kNear = 0.05F;        // metres; nearer points have no pixel

}  // namespace

PoseEvidence pose_evidence(const ModelView& model, const DepthSnapshot& snapshot, const RigidTransform& pose,
                           std::size_t count, double tolerance, double most, double plain_weight) noexcept {
  const FastTransform fast(pose);
  const auto widest = static_cast<float>(most);
  const auto resolvable = static_cast<float>(kResolvable * model.radius());
  const auto far = static_cast<float>(kFarInFront * model.radius());
  const auto base = static_cast<float>(tolerance);
  PoseEvidence evidence;
  count = std::min(count, model.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Point3f p = fast.point(model.positions()[i]);
    const Point3f n = fast.direction(model.normals()[i]);
    const float facing = dot(n, p);
    if (facing >= 0 || facing * facing < kFacing * dot(p, p)) continue;
    ++evidence.facing;
    int u = 0, v = 0;
    if (p.z < kNear || !snapshot.project(p, u, v)) {
      ++evidence.outside;
      continue;
    }
    const std::uint16_t reading = snapshot.depth(u, v);
    if (reading == 0) {
      ++evidence.outside;
      continue;
    }
    const float off = static_cast<float>(reading) * 0.000125F - p.z;
    const float along = std::fabs(facing * off / p.z);
    const float noise = 3 * sigma_at(snapshot.sensor(), p.z);
    const float limit = std::min(base + noise, widest);
    if (along <= limit) {
      const Normal16& seen = snapshot.normal(u, v);
      const float cosine = (n.x * static_cast<float>(seen.x) + n.y * static_cast<float>(seen.y) +
                            n.z * static_cast<float>(seen.z)) *
                           (1.0F / 16384);
      const bool known = seen.x != 0 || seen.y != 0 || seen.z != 0;
      // 1 from 25° (0.9) on, 0 at 60°; half where the surface has no normal.
      const float alike = known ? std::clamp((cosine - 0.5F) * 2.5F, 0.0F, 1.0F) : 0.5F;
      if (alike > 0) {
        ++evidence.agreeing;
        evidence.close += along <= noise ? 1 : 0;
        const float ratio = along / limit;
        const float telling = noise > resolvable ? resolvable / noise : 1;
        evidence.agreement +=
            static_cast<double>(telling * alike * (1 - ratio * ratio)) * (seen.pad != 0 ? plain_weight : 1);
      } else {
        ++evidence.crossing;
      }
    } else {
      ++(off > 0 ? evidence.floating : evidence.behind);
      if (off > 0) evidence.impossible += static_cast<double>(std::min(along / far, 1.0F));
    }
  }
  return evidence;
}

bool refine_pose(const ModelView& model, const DepthSnapshot& snapshot, std::size_t count, double gate,
                 double tolerance, int iterations, RigidTransform& pose) noexcept {
  count = std::min(count, model.size());
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const FastTransform fast(pose);
    const Vector3 pivot = pose * model.centre();
    const Point3f about = {static_cast<float>(pivot.x()), static_cast<float>(pivot.y()),
                           static_cast<float>(pivot.z())};
    const double share = static_cast<double>(iteration) / std::max(1, iterations - 1);
    const auto wide = static_cast<float>(gate + (3 * tolerance - gate) * share);
    NormalEquations6 equations;
    std::size_t held = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Point3f p = fast.point(model.positions()[i]);
      const Point3f n = fast.direction(model.normals()[i]);
      const float facing = dot(n, p);
      if (facing >= 0 || facing * facing < kFacing * dot(p, p)) continue;
      int u = 0, v = 0;
      if (p.z < kNear || !snapshot.project(p, u, v)) continue;
      if (snapshot.depth(u, v) == 0) continue;
      const Normal16& seen = snapshot.normal(u, v);
      const Point3f m = {static_cast<float>(seen.x) * (1.0F / 16384),
                         static_cast<float>(seen.y) * (1.0F / 16384),
                         static_cast<float>(seen.z) * (1.0F / 16384)};
      if (dot(m, n) < kSameNormal) continue;  // also where there is no normal
      const Point3f q = snapshot.vertex(u, v);
      const Point3f gap = {q.x - p.x, q.y - p.y, q.z - p.z};
      const float residual = dot(gap, m);
      const float reach = wide + 3 * sigma_at(snapshot.sensor(), p.z);
      if (std::fabs(residual) > reach) continue;
      // Tukey's weight.
      const float ratio = residual / reach;
      const float w = (1 - ratio * ratio) * (1 - ratio * ratio);
      const Point3f a = {p.x - about.x, p.y - about.y, p.z - about.z};
      const double row[6] = {static_cast<double>(a.y * m.z - a.z * m.y),
                             static_cast<double>(a.z * m.x - a.x * m.z),
                             static_cast<double>(a.x * m.y - a.y * m.x),
                             static_cast<double>(m.x),
                             static_cast<double>(m.y),
                             static_cast<double>(m.z)};
      equations.add(row, static_cast<double>(residual), static_cast<double>(w));
      ++held;
    }
    if (held < 12) return false;
    Vector3 turn, shift;
    // Directions that the surface does not hold stay put: damped against the model's size.
    if (!equations.solve(1e-3 * model.radius() * model.radius(), 1e-3, turn, shift)) return false;
    const Matrix3 rotation = rotation_from_small_vector(turn);
    pose.rotation = orthonormalised(rotation * pose.rotation);
    pose.translation = rotation * (pose.translation - pivot) + pivot + shift;
  }
  return true;
}

}  // namespace pliant

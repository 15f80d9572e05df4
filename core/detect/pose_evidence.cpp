#include "core/detect/pose_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "core/detect/fast_transform.hpp"

namespace pliant {

namespace {

constexpr double kResolvable = 0.06;  // of the model's radius; noise (3 σ) wider than that hides relief
constexpr double kFarInFront = 0.2;   // of the model's radius: no dent is that deep
constexpr float kNear = 0.05F;        // metres; nearer points have no pixel

}  // namespace

PoseEvidence pose_evidence(const ProbePoints& points, const DepthSnapshot& snapshot,
                           const RigidTransform& pose, std::size_t count, double tolerance, double most,
                           double plain_weight) noexcept {
  const auto widest = static_cast<float>(most);
  const auto resolvable = static_cast<float>(kResolvable * points.radius());
  const auto far = static_cast<float>(kFarInFront * points.radius());
  const auto base = static_cast<float>(tolerance);
  PoseEvidence evidence;
  const auto look = [&](const Point3f& p, const Point3f& n, float facing) {
    int u = 0, v = 0;
    if (p.z < kNear || !snapshot.project(p, u, v)) {
      ++evidence.outside;
      return;
    }
    const std::uint16_t reading = snapshot.depth(u, v);
    if (reading == 0) {
      ++evidence.outside;
      return;
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
  };
  evidence.facing = static_cast<int>(points.visit_facing(FastTransform(pose), count, look));
  return evidence;
}

}  // namespace pliant

#include "core/capture/view_search.hpp"

#include <algorithm>
#include <cstdlib>

namespace pliant {

namespace {

constexpr double kLeastAgreement = 0.75;  // of the readings that can be judged
constexpr double kSureAgreement = 0.95;
constexpr std::uint32_t kFewestAgreeing = 120;
constexpr std::size_t kTries = 6;  // kept views
constexpr double kReach = 0.04;    // metres

}  // namespace

bool fits(const ViewFit& fit) noexcept {
  return fit.agreeing >= kFewestAgreeing && fit.agreement() >= kLeastAgreement &&
         fit.agreeing * 2 >= fit.fresh;
}

bool surely_fits(const ViewFit& fit) noexcept {
  return fits(fit) && fit.agreement() >= kSureAgreement;
}

bool stands_before(std::span<const Keyframe> kept, const RigidTransform& pose,
                   std::span<const BackgroundPlane> planes, std::int32_t noise) noexcept {
  constexpr std::size_t kEvery = 16;         // points of a view
  constexpr std::uint32_t kMostBehind = 30;  // one in so many
  const std::int32_t margin =
      5 * noise + 5 * kUnitsPerMillimetre;  // the planes' own unevenness, and the pose's
  std::uint32_t all = 0, behind = 0;
  for (const Keyframe& view : kept) {
    const FixedPose to_camera(pose * view.view.pose.inverse(), Vector3::Zero());
    for (std::size_t i = 0; i < view.point_count; i += kEvery) {
      const ViewPoint& p = view.points[i];
      const IntPoint q = to_camera.point(p.x, p.y, p.z);
      constexpr std::int32_t kFar = (1 << 15) - 1;  // BackgroundPlane::height()
      if (std::abs(q.x) > kFar || std::abs(q.y) > kFar || std::abs(q.z) > kFar) continue;
      ++all;
      behind += std::any_of(planes.begin(), planes.end(),
                            [&](const BackgroundPlane& plane) { return plane.height(q) < -margin; })
                    ? 1U
                    : 0U;
    }
  }
  return behind * kMostBehind <= all;
}

bool find_again(std::span<const ViewPoint> points, std::span<const Keyframe> kept,
                const RigidTransform& last_pose, const SearchTools& tools, ViewFit& fit) noexcept {
  ViewFit best;
  for (std::size_t k = 0; k < std::min(kept.size(), kTries); ++k) {
    const Keyframe& view = kept[kept.size() - 1 - k];
    RigidTransform pose = k == 0 ? last_pose : view.view.pose;
    if (!align_to_picture(points, view.view, tools.projector, tools.rays, kReach, tools.align, tools.rows,
                          pose))
      continue;
    const ViewFit tried = align_to_volume(points, tools.volume, pose, tools.align, tools.rows);
    const bool known = tried.agreeing >= 3 * tried.fresh;
    if (known && surely_fits(tried) && tried.agreement() * tried.agreeing > best.agreement() * best.agreeing)
      best = tried;
  }
  if (best.agreeing == 0) return false;
  fit = best;
  return true;
}

}  // namespace pliant

#include "core/capture/view_search.hpp"

#include <algorithm>

namespace pliant {

namespace {

constexpr double kLeastAgreement = 0.75;  // of the readings that can be judged
constexpr double kSureAgreement = 0.92;
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

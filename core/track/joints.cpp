#include "core/track/joints.hpp"

namespace pliant {

namespace {

/// A border is known to half a patch's radius, and what lies that far from a joint moves by half of it when
/// the part turns by half a radian.
constexpr double kGiveOfRadius = 0.25;
/// A part turns freely by as much, but where the surface does not tell, as of a round limb about itself, it
/// turns with what it hangs on. What is seen of a swing outweighs it a thousand times.
constexpr double kTurn = 0.3;

}  // namespace

Joints find_joints(const PatchTables& patches, const PatchWarp& warp, const RegionSet& regions) noexcept {
  struct Sum {
    Vector3 place = Vector3::Zero(), target = Vector3::Zero();
    double edges = 0;
  };
  std::array<std::array<Sum, 2>, limits::kMaxRegions> sums{};  // to the parent, to others
  std::array<RigidTransform, limits::kMaxRegions> step;
  for (std::size_t k = 0; k < regions.size(); ++k)
    if (regions[k].alive) step[k] = regions[k].pose * regions[k].last_pose.inverse();
  const auto add = [&](std::uint8_t own, std::uint8_t other, const PatchBorder& border) {
    const auto k = static_cast<std::size_t>(warp.home[own]), j = static_cast<std::size_t>(warp.home[other]);
    if (k == 0 || !regions[k].alive || !regions[j].alive) return;
    Sum& sum = sums[k][static_cast<std::size_t>(regions[k].parent) == j ? 0 : 1];
    sum.place += border.edges * border.centre;
    sum.target += border.edges * (step[j] * (warp.pose[other] * border.centre));
    sum.edges += border.edges;
  };
  for (std::size_t b = 0; b < patches.border_count; ++b) {
    const PatchBorder& border = patches.borders[b];
    if (warp.home[border.a] == warp.home[border.b]) continue;
    add(border.a, border.b, border);
    add(border.b, border.a, border);
  }
  Joints joints;
  for (std::size_t k = 1; k < regions.size(); ++k) {
    const bool to_parent = sums[k][0].edges > 0;
    const Sum& sum = sums[k][to_parent ? 0 : 1];
    if (!regions[k].alive || !(sum.edges > 0)) continue;
    joints[k] = {
        true,
        sum.place / sum.edges,
        sum.target / sum.edges,
        kGiveOfRadius * patches.radius,
        to_parent ? regions[static_cast<std::size_t>(regions[k].parent)].pose.rotation : Matrix3::Identity(),
        to_parent ? kTurn : 0};
  }
  return joints;
}

bool find_joint(const PatchTables& patches, const PatchWarp& warp, std::int8_t k, std::int8_t parent,
                Vector3& joint) noexcept {
  Vector3 sum = Vector3::Zero();
  double edges = 0;
  for (std::size_t b = 0; b < patches.border_count; ++b) {
    const PatchBorder& border = patches.borders[b];
    const std::int8_t x = warp.home[border.a], y = warp.home[border.b];
    if (!(x == k && y == parent) && !(x == parent && y == k)) continue;
    sum += border.edges * border.centre;
    edges += border.edges;
  }
  if (!(edges > 0)) return false;
  joint = sum / edges;
  return true;
}

}  // namespace pliant

#include "core/track/region_tree.hpp"

namespace pliant {

namespace {

/// Where a region is: what nobody sees goes with what it hangs on.
RigidTransform place_of(const RegionSet& regions, const TrackedRegion& region) noexcept {
  return region.frames_unseen > 0 && region.parent >= 0
             ? regions[static_cast<std::size_t>(region.parent)].pose * region.from_parent
             : region.pose;
}

}  // namespace

bool hangs_on(const RegionSet& regions, std::int8_t k, std::int8_t on) noexcept {
  for (std::size_t step = 0; step < regions.size() && k >= 0; ++step) {
    k = regions[static_cast<std::size_t>(k)].parent;
    if (k == on) return true;
  }
  return false;
}

void hang(RegionSet& regions, std::size_t k, std::int8_t parent) noexcept {
  TrackedRegion& region = regions[k];
  region.pose = place_of(regions, region);
  region.parent = parent;
  if (parent >= 0)
    region.from_parent = regions[static_cast<std::size_t>(parent)].pose.inverse() * region.pose;
}

void take_motion(RegionSet& regions, std::size_t to, const TrackedRegion& from) noexcept {
  std::array<RigidTransform, limits::kMaxRegions> places;
  for (std::size_t r = 0; r < regions.size(); ++r) places[r] = place_of(regions, regions[r]);
  regions[to].pose = from.pose;
  regions[to].last_pose = from.last_pose;
  regions[to].motion = from.motion;
  regions[to].steps = from.steps;
  regions[to].frames_unseen = from.frames_unseen;
  for (std::size_t r = 0; r < regions.size(); ++r)
    if (regions[r].alive && regions[r].parent == static_cast<std::int8_t>(to)) {
      regions[r].pose = places[r];
      regions[r].from_parent = from.pose.inverse() * places[r];
    }
}

}  // namespace pliant

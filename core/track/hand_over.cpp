#include "core/track/hand_over.hpp"

#include <utility>

namespace pliant {

namespace {

/// Two regions trade ids.
void trade(const RegroupContext& context, RegroupState& state, RegionSet& regions, PointState& points,
           std::int8_t a, std::int8_t b) noexcept {
  const auto traded = [a, b](std::int8_t k) { return k == a ? b : k == b ? a : k; };
  for (std::size_t i = 0; i < points.home.size(); ++i) {
    points.home[i] = traded(points.home[i]);
    points.rival[i] = traded(points.rival[i]);
  }
  for (std::size_t p = 0; p < context.patches.count; ++p) context.warp.home[p] = traded(context.warp.home[p]);
  std::swap(regions[static_cast<std::size_t>(a)], regions[static_cast<std::size_t>(b)]);
  for (TrackedRegion& region : regions)
    if (region.alive) region.parent = traded(region.parent);
  state.suspected = {};
  state.alike = {};
}

}  // namespace

bool hand_over_base(const RegroupContext& context, int frames, RegroupState& state, RegionSet& regions,
                    PointState& points) noexcept {
  std::size_t largest = 0;
  std::uint32_t all = 0;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (!regions[k].alive) continue;
    all += regions[k].facing;
    if (regions[k].facing > regions[largest].facing) largest = k;
  }
  const std::uint32_t base = regions[0].facing;
  const bool outgrown = 3 * base < all && 2 * regions[largest].facing > 3 * base;
  state.outgrown = outgrown ? state.outgrown + 1 : 0;
  if (state.outgrown < frames) return false;
  state.outgrown = 0;
  trade(context, state, regions, points, 0, static_cast<std::int8_t>(largest));
  // the tree turns over: what the base hung on now hangs on it
  regions[0].parent = -1;
  regions[largest].parent = 0;
  for (std::size_t k = 1; k < regions.size(); ++k) {
    if (!regions[k].alive) continue;
    if (regions[k].parent < 0) regions[k].parent = 0;
    regions[k].from_parent =
        regions[static_cast<std::size_t>(regions[k].parent)].pose.inverse() * regions[k].pose;
  }
  return true;
}

}  // namespace pliant

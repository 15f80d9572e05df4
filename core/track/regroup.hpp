// The same again on what one transform does not explain (paper, section 3.2): parts that move apart become
// regions of their own, regions that move alike become one again.
#pragma once

#include "core/track/part_search.hpp"
#include "core/track/patches.hpp"
#include "core/track/sight.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

struct RegroupSettings {
  int max_regions = limits::kMaxRegions;
  std::uint32_t fewest_points = 40;  ///< of a region; derived from the model's size
  int merge_after = 4;               ///< frames in which two regions must move alike
  int split_after = 2;               ///< frames in which a part must move in its own way: one may be noise
};

/// Memory of the regrouping between frames.
struct RegroupState {
  std::array<std::uint8_t, kMaxPatches>
      switching{};  ///< frames in a row in which a neighbour suited a patch better
  std::array<std::array<std::uint8_t, limits::kMaxRegions>, limits::kMaxRegions>
      alike{};  ///< frames in a row in which two regions moved alike, [lower id][higher id]
  std::array<int, limits::kMaxRegions> suspected{};  ///< frames in a row in which a region showed two motions
  int outgrown = 0;  ///< frames in a row in which another region was far larger than the base
};

/// Everything the regrouping looks at.
struct RegroupContext {
  const ModelTables& model;
  const PatchTables& patches;
  PatchWarp& warp;  ///< its homes follow
  const Sighting& sighting;
  const Tolerance& tolerance;
};

/// Lets patches go over to a neighbouring region that suits them better, makes one of regions that one motion
/// suits as well as two, or else makes a region of a part that the warp takes along a rigid motion of its
/// own. Each needs some frames in a row. Where another region has become far larger than the base, as a
/// bending object's may shrink, that one takes its place; at once where a part turns out to be the larger
/// half. True when a region came or went.
bool regroup(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
             RegionSet& regions, PointState& points) noexcept;

}  // namespace pliant

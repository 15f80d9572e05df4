// The same again on what one transform does not explain (paper, section 3.2): parts that move apart become
// regions of their own, regions that move alike become one again.
#pragma once

#include "core/track/motion_split.hpp"
#include "core/track/patches.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

struct RegroupSettings {
  int max_regions = limits::kMaxRegions;
  std::uint32_t fewest_points = 40;  ///< of a region; derived from the model's size
  int merge_after = 10;              ///< frames in which a region must move like its parent
};

/// Memory of the regrouping between frames.
struct RegroupState {
  int pause = 0;  ///< frames until the next try to split outliers off
  std::array<int, limits::kMaxRegions>
      suspected{};  ///< frames in a row in which two motions showed, by region
};

/// Where a region hangs on its neighbours.
struct Joint {
  std::uint32_t edges = 0;           ///< of the surface graph that cross the border
  Vector3 centre = Vector3::Zero();  ///< of the border, model frame, metres
};
[[nodiscard]] Joint joint_of(const ModelTables& model, const PointState& points, std::int8_t region,
                             std::int8_t neighbour) noexcept;

/// Everything the regrouping looks at.
struct RegroupContext {
  const ModelTables& model;
  const PatchTables& patches;
  const Surface& surface;
  const Projector& projector;
  const Tolerance& tolerance;
};

/// Merges regions that moved like their parent for long enough or came off it, splits a region in two where
/// two motions explain it clearly better than one for two frames in a row, and else tries to make a region of
/// a group of outliers. The two sides of a split must stay joined: their motions agree at the centre of the
/// border between them. True when a region came or went.
bool regroup(const RegroupContext& context, const RegroupSettings& settings, RegroupState& state,
             MotionSplit& scratch, RegionSet& regions, PointState& points) noexcept;

}  // namespace pliant

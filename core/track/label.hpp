// The inlier test: which points are where their region puts them, which are off it, and which are not seen.
#pragma once

#include "core/deform/patch_warp.hpp"
#include "core/track/borders.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

/// What a frame shows of the points that face the camera inside the picture.
struct SightCounts {
  std::uint32_t facing = 0;    ///< face the camera inside the picture
  std::uint32_t in_front = 0;  ///< the camera sees through them
  std::uint32_t behind = 0;    ///< something stands before them
  std::uint32_t deformed = 0;  ///< are where the warp puts them, off their region
};

/// What the inlier test looks at.
struct LabelContext {
  const ModelTables& model;
  const PatchTables& patches;
  const PatchWarp& warp;
  const Surface& surface;
  const Projector& projector;
  const Tolerance& tolerance;
  const RegionBorders& borders;
  bool with_memory = true;  ///< evidence gathers over frames; else one frame decides
};

/// Looks at every point where its region puts it and, where that fails or the warp takes it elsewhere, where
/// the warp puts it. Gathers evidence over the frames, lets points go over to a neighbouring region that
/// explains them better, and sets sight, residual, match, label, position and offset.
SightCounts label(const LabelContext& context, const RegionSet& regions, PointState& points) noexcept;

/// Gives every point that was not seen lately the home of the nearest seen point along the model's surface
/// graph.
void carry_homes_to_unseen(const ModelTables& model, PointState& points) noexcept;

}  // namespace pliant

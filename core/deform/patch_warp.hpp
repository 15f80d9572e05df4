// The warp: every patch of the model follows the readings that it sees, held by springs to its neighbours
// and, softly, to its rigid region. A mass-spring model whose masses are small rigid pieces of the surface:
// stretching is stiff, bending is soft, and what nobody sees follows what is seen.
#pragma once

#include <array>

#include "core/deform/elastic_system.hpp"
#include "core/fixed/moments.hpp"
#include "core/track/pose_lanes.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

struct WarpSettings {
  int rounds = 2;            ///< of looking up readings and solving [1, 8]; the next frame goes on from there
  int iterations = 12;       ///< of the solver in each round [1, 64]
  double material = 0.5;     ///< 0 stiff … 1 soft [0, 1]
  std::int32_t inward = 0;   ///< how far behind a point its reading may lie, 1/16 mm
  std::int32_t outward = 0;  ///< how far before it: beyond, it is something else in front, 1/16 mm
};

using PatchMoments = std::array<PlaneMoments, kMaxPatches>;

/// The state of the warp, kept from frame to frame, and its scratch.
struct PatchWarp {
  std::array<RigidTransform, kMaxPatches> pose;  ///< camera <- model, of each patch
  std::array<std::int8_t, kMaxPatches> home{};   ///< region of most of its points
  std::array<double, kMaxPatches> seen{};        ///< weighted readings of this frame
  std::array<bool, kMaxPatches> fits{};          ///< its readings fit as well where its region is
  std::array<bool, kMaxPatches> held{};          ///< is in this frame where its region puts it
  std::array<bool, kMaxPatches> rigid{};  ///< it and its neighbours are exactly where one region puts them

  std::array<StepMemory, kMaxPatches> steps;  ///< of each patch

  // scratch
  PatchMoments moments;       ///< of the readings, where the warp has the patches
  PatchMoments home_moments;  ///< where their regions put them
  std::array<FixedPose, kMaxPatches> fixed;
  std::array<IntPoint, kMaxPatches> centre;
  ElasticSystem system;

  void reset(const RigidTransform& all) noexcept {
    pose.fill(all);
    steps.fill(StepMemory());
  }
};

/// Takes the patches along with the motion of their regions since the last frame, then lets them follow the
/// readings. Uses the poses of `regions` and the homes of `points`; changes `warp` only.
void warp_patches(const ModelTables& model, const PatchTables& patches, const Surface& surface,
                  const Projector& projector, const Tolerance& tolerance, const RegionSet& regions,
                  const WarpSettings& settings, const PointState& points, PatchWarp& warp) noexcept;

/// The poses of a warp's patches, as blending takes them.
using WarpLanes = std::array<PoseLanes, kMaxPatches>;

[[nodiscard]] inline WarpLanes lanes_of(const PatchTables& patches, const PatchWarp& warp) noexcept {
  WarpLanes lanes;
  for (std::size_t p = 0; p < patches.count; ++p) lanes[p] = PoseLanes(warp.fixed[p]);
  return lanes;
}

/// Where the warp puts a point: the blend of what its patches say. Camera frame, 1/16 mm.
[[nodiscard]] inline IntPoint warped_point(const ModelTables& model, const PatchTables& patches,
                                           const WarpLanes& lanes, std::size_t i) noexcept {
  const PointBlend& blend = patches.blend[i];
  PointSum sum(model.x[i], model.y[i], model.z[i], 1 << (PointBlend::kShift - 1));
  for (std::size_t j = 0; j < blend.weight.size() && blend.weight[j] != 0; ++j)
    sum.add(lanes[blend.patch[j]], blend.weight[j]);
  return sum.over(PointBlend::kShift);
}

}  // namespace pliant

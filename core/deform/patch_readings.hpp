// What the depth picture says of every patch: the readings of its points, gathered into the moments of its
// small motions.
#pragma once

#include <algorithm>

#include "core/camera/surface.hpp"
#include "core/deform/patch_warp.hpp"

namespace pliant {

using ChosenPatches = std::array<bool, kMaxPatches>;

/// How far a point's reading may lie from it, 1/16 mm, at most kFarthestReading.
struct ReadingGates {
  std::int32_t inward = 0, outward = 0;
  PixelSpan spacing;

  /// The nearer the patches are, the less a reading far off has to do with them: a quarter less, but not
  /// below `least`.
  void narrow(std::int32_t least) noexcept {
    inward = std::min(std::max(inward * 3 / 4, least), kFarthestReading);
    outward = std::min(std::max(outward * 3 / 4, least), kFarthestReading);
  }
};

/// What the readings are looked up with.
struct PatchLook {
  const ModelTables& model;
  const PatchTables& patches;
  const Surface& surface;
  const Projector& projector;
  ReadingGates gates;
  int step = 1;  ///< pixels between looks aside
};

/// How well readings fit a patch.
struct PatchFit {
  double weight = 0;    ///< of readings
  double square = 0;    ///< mean residual squared, metres squared
  bool pulled = false;  ///< its own motion would lower the sum of squares by much
};

/// Of all readings that a patch could have, the share that its region's pull is worth for a patch that its
/// readings put where its region is: half of what they weigh, since along the surface they do not hold it,
/// and springs would drag it after a part that moves.
inline constexpr double kHoldShare = 0.5;

/// Looks up the readings of the chosen patches' points where the warp has them: warp.moments, and the integer
/// poses.
void gather_readings(const PatchLook& look, const PointState& points, const ChosenPatches& chosen,
                     PatchWarp& warp) noexcept;

/// The same into `moments`, and how well they fit: does a patch's own motion lower the sum of squares by more
/// than `much`, in weighted readings times metres squared? What lies aside of a point counts as far as the
/// next few pixels for the fit, and as far as the gates reach for the moments.
void measure_fits(const PatchLook& look, const PointState& points, const ChosenPatches& chosen, double much,
                  PatchWarp& warp, PatchMoments& moments, std::array<PatchFit, kMaxPatches>& fits) noexcept;

/// Adds a patch's readings to its normal equations: radians and metres about its centre.
void add_readings(const PlaneMoments& m, Symmetric6& a, Vector6& b) noexcept;

/// The centres and integer poses of the chosen patches.
void place_patches(const ModelTables& model, const PatchTables& patches, const ChosenPatches& chosen,
                   PatchWarp& warp) noexcept;

}  // namespace pliant

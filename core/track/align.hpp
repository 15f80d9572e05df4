// Robust point-to-plane alignment of every region to its correspondences.
#pragma once

#include "core/camera/sensor.hpp"
#include "core/fixed/moments.hpp"
#include "core/track/joints.hpp"

namespace pliant {

struct AlignSettings {
  /// readings farther off than this weigh nothing, by region, 1/16 mm; at least 1.6 σ
  std::array<std::int32_t, limits::kMaxRegions> widest{};
  double prior_rotation =
      0.05;  ///< how far a region turns off its prediction, one standard deviation, radians
  double prior_translation = 0.01;  ///< and moves, metres
  double half_radius = 0;           ///< of the body, metres: how far a turn by a radian moves it
  bool robust = true;               ///< Tukey weights; else equal ones up to their limit
};

/// How far every region was moved, metres; negative where none was found: too few readings, or no sound step.
using AlignSteps = std::array<double, limits::kMaxRegions>;

/// One Gauss–Newton step for every region with correspondences: Tukey weights at a scale from the median
/// residual (never below the sensor's noise), the prediction as a prior that decides where the surface does
/// not, joints that hold what slides along itself or turns about itself. Updates pose, scale and rms. Regions
/// with too few correspondences keep their prediction.
AlignSteps align(const Surface& surface, const AlignSettings& settings, const Joints& joints,
                 const PointState& points, RegionSet& regions) noexcept;

/// Fewest correspondences that move a region.
inline constexpr std::uint32_t kFewestCorrespondences = 24;

}  // namespace pliant

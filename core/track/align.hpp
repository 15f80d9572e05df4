// Robust point-to-plane alignment of every region to its correspondences.
#pragma once

#include "core/camera/sensor.hpp"
#include "core/fixed/moments.hpp"
#include "core/track/joints.hpp"

namespace pliant {

struct AlignSettings {
  std::int32_t widest = 0;  ///< readings farther off than this weigh nothing, 1/16 mm; at least 1.6 σ
  double prior_rotation =
      0.05;  ///< how far a region turns off its prediction, one standard deviation, radians
  double prior_translation = 0.01;  ///< and moves, metres
  bool robust = true;               ///< Tukey weights; else equal ones up to their limit
};

/// One Gauss–Newton step for every region with correspondences: Tukey weights at a scale from the median
/// residual (never below the sensor's noise), the prediction as a prior that decides where the surface does
/// not, joints that hold what slides along itself or turns about itself. Updates pose, scale and rms. Regions
/// with too few correspondences keep their prediction.
void align(const Surface& surface, const AlignSettings& settings, const Joints& joints,
           const PointState& points, RegionSet& regions) noexcept;

/// Fewest correspondences that move a region.
inline constexpr std::uint32_t kFewestCorrespondences = 24;

}  // namespace pliant

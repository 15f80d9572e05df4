#include "core/capture/capture_settings.hpp"

#include <algorithm>
#include <cmath>

#include "core/camera/surface.hpp"

namespace pliant {

double usual_noise(const SensorDescription& sensor) noexcept {
  constexpr double kUsualDistance = 0.6;
  return sensor.sigma(kUsualDistance);
}

VolumePlan volume_plan(const CaptureSettings& settings, const SensorDescription& sensor) noexcept {
  constexpr double kBackSigmas = 4;
  const double sigma = usual_noise(sensor);
  const double wished = settings.voxel > 0 ? settings.voxel : kVoxelSigmas * sigma;
  const double finest = settings.size / (kMostVoxels - 1);
  VolumePlan plan;
  plan.voxel = std::max(8, static_cast<std::int32_t>(std::ceil(std::max(wished, finest) * kUnitsPerMetre)));
  const int needed = static_cast<int>(std::ceil(settings.size * kUnitsPerMetre / plan.voxel)) + 1;
  plan.cells = std::clamp((needed + kBlock - 1) / kBlock * kBlock, 4 * kBlock, kMostVoxels);
  plan.front = 5 * plan.voxel;
  plan.back = std::max(3 * plan.voxel, static_cast<std::int32_t>(kBackSigmas * sigma * kUnitsPerMetre));
  return plan;
}

}  // namespace pliant

#include "core/camera/sensor.hpp"

#include "core/limits.hpp"

namespace pliant {

static_assert(SensorDescription::kFarLimit.high == limits::kMaxDepth);

const char* sensor_fault(const SensorDescription& sensor) noexcept {
  if (!SensorDescription::kNoiseFloor.holds(sensor.noise_floor))
    return "noise_floor must be 0.0001 to 0.05 m";
  if (!SensorDescription::kNoiseGrowth.holds(sensor.noise_growth)) return "noise_growth must be 0 to 0.1 1/m";
  if (!SensorDescription::kNearLimit.holds(sensor.near_limit)) return "near_limit must be 0.05 to 4 m";
  if (!SensorDescription::kFarLimit.holds(sensor.far_limit)) return "far_limit must be 0.2 to 8 m";
  if (sensor.near_limit >= sensor.far_limit) return "near_limit must be less than far_limit";
  return nullptr;
}

}  // namespace pliant

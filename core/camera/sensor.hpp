// What a depth sensor's readings are worth.
#pragma once

namespace pliant {

/// Axial noise of a reading at depth z: noise_floor + noise_growth * (z - 0.4 m)^2, one standard deviation.
/// Defaults: structured light of the PrimeSense family (Nguyen, Izadi, Lovell: Modeling Kinect Sensor Noise
/// for Improved 3D Reconstruction and Tracking, 3DIMPVT 2012, eq. 3).
struct SensorDescription {
  /// What a number may be.
  struct Range {
    double low, high;
    /// False for NaN.
    [[nodiscard]] constexpr bool holds(double x) const noexcept { return x >= low && x <= high; }
  };
  static constexpr Range kNoiseFloor = {0.0001, 0.05}, kNoiseGrowth = {0, 0.1}, kNearLimit = {0.05, 4},
                         kFarLimit = {0.2, 8};

  double noise_floor = 0.0012;   ///< metres, within kNoiseFloor
  double noise_growth = 0.0019;  ///< 1/metres, within kNoiseGrowth
  double near_limit = 0.3;       ///< metres, within kNearLimit; nearer readings are not used
  double far_limit = 4.0;        ///< metres, within kFarLimit; farther readings are not used

  [[nodiscard]] double sigma(double z) const noexcept {
    return noise_floor + noise_growth * (z - 0.4) * (z - 0.4);
  }
};

/// What is wrong with the description in words, or null: every number within its range, near below far.
[[nodiscard]] const char* sensor_fault(const SensorDescription& sensor) noexcept;

}  // namespace pliant

// What a depth sensor's readings are worth.
#pragma once

namespace pliant {

/// Axial noise of a reading at depth z: noise_floor + noise_growth * (z - 0.4 m)^2, one standard deviation.
/// Defaults: structured light of the PrimeSense family (Nguyen, Izadi, Lovell: Modeling Kinect Sensor Noise
/// for Improved 3D Reconstruction and Tracking, 3DIMPVT 2012, eq. 3).
struct SensorDescription {
  double noise_floor = 0.0012;   ///< metres [0.0001, 0.05]
  double noise_growth = 0.0019;  ///< 1/metres [0, 0.1]
  double near_limit = 0.3;       ///< metres [0.05, 4]; nearer readings are not used
  double far_limit = 4.0;        ///< metres [0.2, 8]; farther readings are not used

  [[nodiscard]] double sigma(double z) const noexcept {
    return noise_floor + noise_growth * (z - 0.4) * (z - 0.4);
  }
};

}  // namespace pliant

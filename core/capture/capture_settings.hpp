// What the capture of a model may be told, and what follows from it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/track_settings.hpp"

namespace pliant {

struct CaptureSettings {
  double size = 0.50;  ///< edge of the cube that holds the object, metres [0.05, 1.0]
  double voxel = 0;  ///< metres; 0: follows the sensor's noise and `size` (see volume_plan()) [0.0005, 0.02]
  double clearance =
      0;  ///< height above the table below which nothing is taken, metres; 0: from noise [0, 0.2]
  bool separate_views = false;  ///< a few pictures from far apart rather than a camera's stream: each counts
  int at_u = -1;  ///< a pixel of the object in the first picture; -1: the one nearest the middle
  int at_v = -1;  ///< likewise
  Kernels kernels = Kernels::automatic;  ///< bodies of the integer kernels
};

/// Views that are kept to close the drift and to fuse from anew: a turn in steps of 9° and eight more.
inline constexpr std::size_t kMaxKeyframes = 48;
/// Points of a view that take part in its alignment.
inline constexpr std::size_t kViewPoints = 2048;
/// Voxels along an edge of the volume, a multiple of kBlock; 64 MB.
inline constexpr int kMostVoxels = 256;
/// Voxels along an edge of a block, the piece of the volume that is fused at once.
inline constexpr int kBlock = 8;

/// The grid that the settings ask for.
struct VolumePlan {
  int cells = 0;           ///< nodes along an edge
  std::int32_t voxel = 0;  ///< 1/16 mm between nodes
  std::int32_t front = 0;  ///< distances before the surface are told up to here, 1/16 mm
  std::int32_t back = 0;   ///< and behind it, 1/16 mm

  [[nodiscard]] std::int32_t half() const noexcept { return (cells - 1) * voxel / 2; }
  [[nodiscard]] std::size_t nodes() const noexcept {
    const auto n = static_cast<std::size_t>(cells);
    return n * n * n;
  }
  [[nodiscard]] int blocks() const noexcept { return cells / kBlock; }
};

/// σ of a reading at 0.6 m, the distance at which objects are usually shown, metres.
[[nodiscard]] double usual_noise(const SensorDescription& sensor) noexcept;

/// Width of a voxel in usual_noise().
inline constexpr double kVoxelSigmas = 1.5;
/// Voxels as wide as kVoxelSigmas times usual_noise(): finer ones would only store noise. Not finer than
/// kMostVoxels allow. Distances are told up to five voxels before the surface, which is how far alignment
/// looks, and up to three behind it, at least 4 σ.
[[nodiscard]] VolumePlan volume_plan(const CaptureSettings& settings,
                                     const SensorDescription& sensor) noexcept;

}  // namespace pliant

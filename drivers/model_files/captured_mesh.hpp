// The surface of a captured volume.
#pragma once

#include "core/capture/distance_volume.hpp"
#include "drivers/geometry_files/geometry.hpp"

namespace pliant {

struct CapturedMeshSettings {
  /// Weight (see integrate.hpp) below which a node is not believed: half a straight view, or some flat ones.
  int least_weight = 8;
  /// Parts smaller than this share of the largest are islands and go [0, 1].
  double least_part = 0.1;
  /// Height of the table in the model's frame, metres; what lies lower, and flat remains on it, goes.
  double table_height = -1e3;
  /// Rounds of smooth_grain() [0, 100]: a voxel's edge is about what the sensor's noise leaves uncertain, so
  /// what is as short as some voxels is grain, and would turn the normals.
  int smoothing = 10;
};

/// Triangles wound outward and unit normals, model frame, metres; with a border where nothing was seen. Empty
/// when nothing was captured.
[[nodiscard]] Geometry captured_mesh(const DistanceVolume& volume, const CapturedMeshSettings& settings);

}  // namespace pliant

// The surface of a captured volume.
#pragma once

#include "core/capture/distance_volume.hpp"
#include "drivers/geometry_files/geometry.hpp"

namespace pliant {

/// Weight (see integrate.hpp) of half a straight view, or of some flat ones: what is believed while views
/// still come.
inline constexpr int kSeenWell = 8;

struct CapturedMeshSettings {
  /// Weight below which a node is not believed: that of the flattest reading. Each kept
  /// view stands for some nine degrees of pictures, and what is seen between two parts of an object is often
  /// seen in one of them, and flat; what flickers was left out of the views.
  int least_weight = 2;
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

/// Distance between the points of a model of `captured`, metres: that of the usual number of points, which is
/// what all the patches need that the warp can have: a limb must be some patches, and enough points to count
/// as a part. Not more than four σ (`sigma`: of a reading, metres), which the inlier test allows, and not
/// less than a voxel is wide, between which the surface is but drawn; of a small object as little as it takes
/// for all keypoints that a model has room for.
[[nodiscard]] double captured_spacing(const Geometry& captured, double sigma);

}  // namespace pliant

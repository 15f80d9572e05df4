// Points of the surface captured so far, while it grows: to be looked at, not to be tracked.
#pragma once

#include <cstddef>
#include <span>

#include "core/capture/distance_volume.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// Fills `points` (model frame, metres) and `normals` (unit, Q14), two spans of the same size, with points
/// scattered evenly over the surface where it was seen well enough to be believed (`least_weight`, see
/// integrate.hpp). Returns how many there are. Reads the active part of the volume once or twice.
[[nodiscard]] std::size_t surface_points(const DistanceVolume& volume, int least_weight,
                                         std::span<Point3f> points, std::span<Normal16> normals) noexcept;

}  // namespace pliant

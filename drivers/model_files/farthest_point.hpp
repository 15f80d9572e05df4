// Farthest-point order: each point is the one farthest from all before it, so that any prefix is an even
// sampling (Eldar et al.: The farthest point strategy for progressive image sampling, IEEE TIP 1997).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

/// Indices of `points` in that order, beginning with the point farthest from the middle of the bounding box;
/// of equals the lowest index. Ends after `most` points, or before the first that would lie nearer than
/// `least_distance` to one already taken.
[[nodiscard]] std::vector<std::uint32_t> farthest_point_order(std::span<const Vector3> points,
                                                              std::size_t most, double least_distance = 0);

}  // namespace pliant

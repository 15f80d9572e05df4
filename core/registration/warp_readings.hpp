// What the scene asks of the patches of a warp: matches that pull, and surface that lies near.
#pragma once

#include <cstddef>

#include "core/registration/warp_starts.hpp"

namespace pliant {

/// Places the points of patches that may move, at most 2500 of them (the first points of the model are spread
/// evenly); returns how many.
[[nodiscard]] std::size_t place_free(Warp& w) noexcept;

/// The scene points within `reach` (metres) of the free part, at most about 2500, with the normals of the
/// working cloud, to room.targets; returns how many.
[[nodiscard]] std::size_t near_scene(Warp& w, std::size_t free_count, double reach) noexcept;

/// The first `pulls` matches of room.pulls pull at their patches, each by `weight` less what its distance
/// takes away up to `limit` (metres).
void add_pulls(Warp& w, std::size_t pulls, double weight, double limit) noexcept;

/// Readings of every free point, and of every scene point near the free part, up to `gate` (metres) away.
void add_readings(Warp& w, std::size_t free_count, std::size_t target_count, double gate) noexcept;

}  // namespace pliant

// Every capacity of the core. Memory follows from these and from the model and frame size in use;
// Tracker::workspace_bytes() tells how much.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pliant::limits {

/// Model points. Indices fit 16 bits.
inline constexpr std::size_t kMaxModelPoints = 16384;
/// Model keypoints whose descriptors are stored in the model image.
inline constexpr std::size_t kMaxModelKeypoints = 2048;
/// Neighbours of a model point in its surface graph.
inline constexpr std::size_t kNeighbours = 8;
/// Frame size, pixels.
inline constexpr int kMaxFrameWidth = 1920;
inline constexpr int kMaxFrameHeight = 1200;
inline constexpr int kMinFrameWidth = 32;
inline constexpr int kMinFrameHeight = 24;
/// Rigid regions followed at once; the base region is one of them.
inline constexpr int kMaxRegions = 8;
/// Patches of the model's surface that the warp moves; 25 points each for a model of 6,000. Indices fit 8
/// bits.
inline constexpr std::size_t kMaxPatches = 240;
/// Borders between patches: on a surface a patch has six neighbours on average, and two patches share a
/// border.
inline constexpr std::size_t kMaxBorders = 5 * kMaxPatches;
/// Links across the body: a patch has one patch, or the border of two, on the other side of it.
inline constexpr std::size_t kMaxBodyLinks = 2 * kMaxPatches;
/// Half of the largest extent of a model that can be tracked: 16-bit coordinates at 1/16 mm.
inline constexpr double kMaxModelHalfExtent = 2.0;
/// Farthest depth used, metres: 16-bit depth at 1/8 mm.
inline constexpr double kMaxDepth = 8.0;

}  // namespace pliant::limits

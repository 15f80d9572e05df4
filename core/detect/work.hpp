// What things cost, to be added up: the same on every machine, unlike time.
#pragma once

#include <cstdint>

namespace pliant {

/// About how many instructions each thing takes that is done many times, measured on x86-64. Their sum tells
/// how long a registration takes, the same on every machine.
namespace work {
inline constexpr std::uint64_t kNormal = 12000;
inline constexpr std::uint64_t kDescriptor = 60000;
inline constexpr std::uint64_t kPictureDescriptor = 15000;  // of a picture, which shows one side
inline constexpr std::uint64_t kComparison = 24;            // of two descriptors
inline constexpr std::uint64_t kVote = 12;                  // of a match on a pose
inline constexpr std::uint64_t kNearest = 250;              // the nearest point to one
inline constexpr double kCandidate = 7;                     // a point that might have been nearer
inline constexpr std::uint64_t kThinned = 200;              // a reading put into its cell
inline constexpr std::uint64_t kReading = 600;              // of the warp
inline constexpr std::uint64_t kLimb = 40000000;            // of the warp: a limb in all its attitudes
inline constexpr std::uint64_t kLattice = 2000;         // of a picture: a normal, its place in the sampling
inline constexpr std::uint64_t kPoseVote = 5000;        // of the votes for a pose
inline constexpr std::uint64_t kProbeStep = 90;         // of a step of a pose's alignment, a point
inline constexpr std::uint64_t kSolve = 2000;           // of such a step, once
inline constexpr std::uint64_t kProbeLook = 90;         // of a look at a pose, a point
inline constexpr std::uint64_t kSeam = 80000;           // of what lies around a pose
inline constexpr std::uint64_t kPlainBody = 3500000;    // of the plain bodies where a pose is
inline constexpr std::uint64_t kSelfLikeness = 500000;  // of the model moved against itself
}  // namespace work

}  // namespace pliant

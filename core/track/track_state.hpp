// What the tracker keeps from frame to frame, and the buffers of a frame.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/camera/surface.hpp"
#include "core/fixed/moment_rows.hpp"
#include "core/geometry/vector6.hpp"
#include "core/limits.hpp"
#include "core/track/model_tables.hpp"
#include "core/track_result.hpp"

namespace pliant {

/// Frames without motion after which a body is at rest: a fifth of a second at 30 Hz.
inline constexpr int kUntilAtRest = 6;

/// What is remembered of a pose's steps: their mean over some frames, the latest counting most, turn times
/// half radius and shift, metres. Noise cancels in it, motion does not.
struct StepMemory {
  Vector6 mean = Vector6::Zero();
  int still = 0;  ///< frames in a row in which that mean was within noise, up to kUntilAtRest
};

/// A region that is followed. Its slot in RegionSet is its id.
struct TrackedRegion {
  bool alive = false;
  std::int8_t parent = -1;     ///< id, -1 for the base
  RigidTransform pose;         ///< camera <- model
  RigidTransform last_pose;    ///< of the last frame
  RigidTransform predicted;    ///< of this frame, before alignment
  RigidTransform motion;       ///< camera frame, from the last frame to this one
  RigidTransform from_parent;  ///< parent's model frame <- this region's: how it moved against its parent
  std::uint32_t points = 0;    ///< that bear its label in this frame
  std::uint32_t members = 0;   ///< model points whose home it is
  std::uint32_t facing = 0;    ///< of those, that face the camera with a reading, be it of what hides them
  std::int32_t scale = 0;      ///< robust spread of its residuals, 1/16 mm
  double rms = 0;              ///< metres
  int frames_unseen = 0;       ///< frames in a row without enough readings
  StepMemory steps;            ///< of its pose
};

using RegionSet = std::array<TrackedRegion, limits::kMaxRegions>;
using RegionPoses = std::array<FixedPose, limits::kMaxRegions>;

/// The same value for every region.
template <typename Value>
[[nodiscard]] std::array<Value, limits::kMaxRegions> for_every_region(const Value& value) noexcept {
  std::array<Value, limits::kMaxRegions> all;
  all.fill(value);
  return all;
}

[[nodiscard]] int count_alive(const RegionSet& regions) noexcept;
/// Of those alive. `centre`: of the model.
[[nodiscard]] RegionPoses fixed_poses(const RegionSet& regions, const Vector3& centre) noexcept;

/// How the last look at a point went.
enum class Sight : std::uint8_t {
  none,      ///< turned away, outside the picture, no reading
  agrees,    ///< the surface is where its region puts it
  in_front,  ///< the camera sees through it: the surface lies behind
  behind     ///< the surface lies before it: hidden, or bulged
};

/// One model point beside the reading at its pixel, under its region's pose.
struct Correspondence {
  IntPoint point;           ///< where the pose puts the point, camera frame, 1/16 mm
  std::int16_t nx, ny, nz;  ///< its normal there, Q14
  std::uint16_t index;      ///< of the model point
  std::int32_t residual;    ///< signed distance of the reading along the normal, 1/256 mm
  std::int8_t region;
};

/// Per-point arrays and buffers; all of the model's size unless said.
struct PointState {
  std::span<std::int8_t> home;  ///< region the point belongs to
  std::span<std::uint8_t>
      evidence;  ///< frames' worth of evidence that it is off its region [0, kEvidenceMax]
  std::span<std::uint8_t> switching;  ///< evidence that it belongs to `rival`
  std::span<std::int8_t> rival;       ///< region that explains it better
  std::span<Sight> sight;
  std::span<std::int8_t> label;
  std::span<std::int32_t> match;
  std::span<std::int32_t> residual;  ///< 1/16 mm, signed, along the normal
  std::span<std::int32_t> misfit;    ///< where the surface usually is off the point while it stays on its
                                     ///< region: the model's own error there, along the normal, 1/256 mm
  std::span<IntPoint> position;      ///< camera frame, 1/16 mm
  std::span<IntPoint> offset;      ///< of a deformed point from where its home puts it, camera frame, 1/16 mm
  std::span<std::int32_t> group;   ///< scratch: component or distance
  std::span<std::uint16_t> queue;  ///< scratch: breadth-first search
  std::span<Correspondence> correspondences;
  std::size_t correspondence_count = 0;
  AddMomentRows add_rows = add_moment_rows_scalar;  ///< body of the kernel for sums over points
  std::int32_t frames = 0;  ///< since the object was taken up, up to one more than kMisfitFirstFrames

  void lay_out(Workspace& workspace, std::size_t points) noexcept;
  /// Everything belongs to the base and nothing is deformed.
  void reset() noexcept;
};

/// What PointState carries from one frame to the next.
struct PointMemory {
  std::span<std::int8_t> home, rival;
  std::span<std::uint8_t> evidence, switching;
  std::span<Sight> sight;
  std::span<std::int32_t> misfit;
  std::span<IntPoint> offset;
  std::int32_t frames = 0;

  void lay_out(Workspace& workspace, std::size_t points) noexcept;
  void keep(const PointState& points) noexcept;
  void give_back(PointState& points) const noexcept;
};

inline constexpr std::uint8_t kEvidenceMax = 8;
/// Evidence from which a point counts as deformed: two clear frames, since one may be noise.
inline constexpr std::uint8_t kEvidenceDeformed = 4;

/// Frames over which a point's misfit is averaged: two seconds at 30 Hz, far slower than a hand.
inline constexpr std::int32_t kMisfitFrames = 64;
/// First frames after the object was taken up, whose plain mean the misfit starts from.
inline constexpr std::int32_t kMisfitFirstFrames = 4;

/// No reading farther from a point than this, along each axis of the camera or off its surface, says anything
/// of it, 1/16 mm: 512 mm. What integer kernels rest their overflow bounds on.
inline constexpr std::int32_t kFarthestReading = 8191;

/// What smoothing over nine pixels leaves of σ: residuals below it tell no place from another.
inline constexpr double kSmoothedNoise = 0.35;

/// Lengths that a frame's decisions rest on, from the model's spacing and the sensor's noise.
struct Tolerance {
  const Surface* surface = nullptr;
  std::int32_t spacing = 0;  ///< 1/16 mm
  /// How far off its region's surface a point is deformed: the larger of one spacing and 4 σ of the depth
  /// there, at most kFarthestReading.
  [[nodiscard]] std::int32_t deformed(std::int32_t z16) const noexcept {
    return std::min(std::max(4 * surface->sigma(z16), spacing), kFarthestReading);
  }
  /// kSmoothedNoise of the depth there.
  [[nodiscard]] std::int32_t smoothed_noise(std::int32_t z16) const noexcept {
    constexpr auto kShare = static_cast<std::int32_t>(kSmoothedNoise * 1024);
    return (std::min(surface->sigma(z16), kFarthestReading) * kShare) >> 10;
  }
};

}  // namespace pliant

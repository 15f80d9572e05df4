// What the tracker says about one frame.
#pragma once

#include <cstdint>
#include <span>

#include "core/geometry/rigid_transform.hpp"

namespace pliant {

enum class TrackState : std::uint8_t {
  searching,  ///< not found yet
  tracking,   ///< found in this frame; all of the result holds
  lost        ///< was tracked before, not found in this frame; being searched for
};

/// Labels of model points beside region ids >= 0.
inline constexpr std::int8_t kDeformed = -1;  ///< seen, off every rigid region
inline constexpr std::int8_t kNotObserved =
    -2;  ///< no reading of it in this frame; its position is carried along

/// One part of the object that moves rigidly.
struct Region {
  std::int8_t id = 0;        ///< 0: the base region
  std::int8_t parent = -1;   ///< id of the region it hangs on, -1 for the base
  std::uint32_t points = 0;  ///< model points that bear its label in this frame
  float rms = 0;             ///< of their distances to the surface, metres
  float confidence = 0;      ///< [0, 1]
  RigidTransform pose;       ///< camera <- model, metres
  Point3f joint;  ///< where it hangs on its parent, camera frame, metres; not a number for the base and where
                  ///< the two do not touch
};

/// The steps of a frame, for time profiles.
enum class Stage : std::uint8_t { surface, predict, associate, align, label, regroup, deform, detect };
inline constexpr int kStageCount = 8;

/// Told after each stage of a frame. The core has no clock: the caller stamps.
struct StageObserver {
  void (*stage_done)(void* context, Stage stage) = nullptr;
  void* context = nullptr;
};

/// Valid until the next call of Tracker::process(). The spans have one entry a model point, in the model's
/// order, and are empty unless the state is tracking.
struct TrackResult {
  std::int64_t utime = 0;  ///< capture time of the frame, microseconds
  std::int64_t frame = 0;  ///< the frame's number
  TrackState state = TrackState::searching;
  bool frame_used = true;  ///< false: the frame could not be read (no memory, another size than the camera's,
                           ///< rows that overlap) and changed nothing; one without any reading is used
  float confidence = 0;    ///< [0, 1]
  RigidTransform pose;     ///< the base region, camera <- model, metres
  std::span<const Region> regions;  ///< base first (when observed), then ascending ids
  std::span<const Point3f>
      positions;  ///< camera frame, metres; of a rigid point within the inlier limit of where its region puts
                  ///< it, or off that by what the surface has been off the model there
  std::span<const std::int8_t> labels;    ///< region id, kDeformed or kNotObserved
  std::span<const std::int32_t> matches;  ///< pixel v * width + u, -1 none
  std::span<const float> residuals;       ///< distance to the matched reading, metres; 0 without a match
  std::span<const float> strains;  ///< relative change in length of the surface around a deformed point, root
                                   ///< mean square over its directions; 0 for other points
  float strain_energy = 0;         ///< Strain::energy (core/deform/strain.hpp); 0 unless tracking
};

}  // namespace pliant

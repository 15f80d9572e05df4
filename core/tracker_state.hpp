// All of the tracker's memory; lives at the front of its block.
#pragma once

#include "core/camera/surface.hpp"
#include "core/deform/strain.hpp"
#include "core/detect/frame_detector.hpp"
#include "core/track/label.hpp"
#include "core/track/regroup.hpp"
#include "core/track/track_state.hpp"
#include "core/tracker.hpp"

namespace pliant {

/// How the search for the object goes.
enum class SearchState : std::uint8_t {
  idle,     ///< the next frame begins one
  working,  ///< the detector is at work on a frame
  found     ///< its answer waits for the next frame
};

/// What a frame begins from, to return to when it fails.
struct LastFrame {
  RegionSet regions;
  std::array<RigidTransform, kMaxPatches> patches;
  std::array<StepMemory, kMaxPatches> patch_steps;
  RegroupState regroup;
  PointMemory points;
};

struct TrackerState {
  // What start() was given.
  ModelView model;
  Intrinsics camera;
  SensorDescription sensor;
  TrackSettings settings;
  StageObserver observer;
  double work_level = 1;

  // Tables and buffers.
  ModelTables tables;
  Surface surface;
  Projector projector;
  Tolerance tolerance;
  PatchTables patches;
  PointState points;
  FrameDetector detector;
  std::span<std::uint32_t> taken_pixels;
  std::span<Point3f> positions;
  std::span<float> residuals, strains;

  // The object.
  RegionSet regions;
  LastFrame last_frame;
  RegroupState regroup_state;
  PatchWarp warp;
  Strain strain;
  SightCounts counts;
  bool following = false;    // regions hold a pose to go on from
  bool was_tracked = false;  // ever
  bool just_lost = false;    // regions hold the pose at which it was lost: a hint where to search
  SearchState search = SearchState::idle;
  bool seen_before = false;  // by the search before this one, at place_before
  Vector3 place_before = Vector3::Zero();
  int frames_failed = 0;  // in a row, while following
  double confidence = 0;

  std::array<Region, limits::kMaxRegions> published{};
  TrackResult result;

  void lay_out(Workspace& workspace, const ModelView& model_view, const Intrinsics& intrinsics) noexcept;
};

/// The steps of a followed frame, in their order (tracker_steps.cpp).
void observe_surface(TrackerState& s, const DepthFrame& frame) noexcept;
void predict_regions(TrackerState& s) noexcept;
void align_regions(TrackerState& s) noexcept;
void warp_surface(TrackerState& s) noexcept;
void regain_base(TrackerState& s) noexcept;
void label_points(TrackerState& s) noexcept;
void regroup_outliers(TrackerState& s) noexcept;
void match_deformed(TrackerState& s) noexcept;
/// What the springs say of the warp: how far the surface is strained.
void weigh_strain(TrackerState& s) noexcept;
/// True when what is seen bears the pose out. Sets confidence.
[[nodiscard]] bool judge(TrackerState& s) noexcept;

void remember_last_frame(TrackerState& s) noexcept;
/// Forgets all that a failed frame did.
void return_to_last_frame(TrackerState& s) noexcept;

/// The object is at `pose`, whole and at rest; nothing is known of it from before.
void take_up(TrackerState& s, const RigidTransform& pose) noexcept;

/// Tries to take the object up at `pose` in this frame; true when what is seen bears it out.
[[nodiscard]] bool acquire(TrackerState& s, const DepthFrame& frame, const RigidTransform& pose) noexcept;

/// Writes result from the state of a tracked frame.
void publish_tracked(TrackerState& s) noexcept;

}  // namespace pliant

// Captures an object: one camera, one depth picture after the other, fused into a volume from which its
// surface is taken.
#pragma once

#include <cstddef>
#include <span>

#include "core/camera/depth_frame.hpp"
#include "core/camera/surface.hpp"
#include "core/capture/background.hpp"
#include "core/capture/capture_settings.hpp"
#include "core/capture/coverage.hpp"
#include "core/capture/distance_volume.hpp"
#include "core/capture/integrate.hpp"
#include "core/capture/joint_alignment.hpp"
#include "core/capture/keyframes.hpp"
#include "core/capture/object_cells.hpp"
#include "core/capture/pose_trail.hpp"
#include "core/capture/standstill.hpp"

namespace pliant {

enum class CaptureState : std::uint8_t {
  waiting,    ///< nothing stands before the background yet
  capturing,  ///< the picture was fused
  lost        ///< the view could not be aligned: nothing was fused
};

/// What is said of one picture.
struct CaptureStatus {
  CaptureState state = CaptureState::waiting;
  std::int64_t frame = 0;    ///< its number
  bool too_near = false;     ///< most of the picture has no reading
  bool too_far = false;      ///< noise exceeds a voxel where the object is
  bool too_fast = false;     ///< the object moved farther than alignment reaches, or nearly
  bool too_large = false;    ///< the object reaches out of the volume
  bool featureless = false;  ///< its shape does not hold the view: a ball, a plate
  /// Share of the views fused last in which the object stood in the same pixels: featureless may then only
  /// mean that it has not moved yet.
  double standing = 0;
  bool against = false;  ///< something that moves against the object is left out
  double distance = 0;   ///< of the object, metres; 0 while waiting
  double agreement = 0;  ///< share of the judged readings that fit [0, 1]
  double rms = 0;        ///< of their distances from the fused surface, metres
  double held = 0;       ///< see ViewFit::held
  RigidTransform pose;   ///< camera <- model, while capturing
};

/// All that happened so far.
struct CaptureFigures {
  std::int64_t frames = 0, fused = 0, lost = 0, featureless = 0;
  /// The most pictures on end that were featureless after one that was not: the handle went out of sight.
  std::int64_t longest_unheld = 0;
};

/// Memory is the block given to start(); no heap call afterwards. Model frame: origin in the middle of the
/// cube, z along the table's normal (without a table: against the picture's v), y away from the first view.
class ObjectCapture {
 public:
  [[nodiscard]] static std::size_t workspace_bytes(const Intrinsics& camera, const SensorDescription& sensor,
                                                   const CaptureSettings& settings) noexcept;
  /// Null when well, else what is wrong in words. The block (aligned to Workspace::kAlignment) must outlive
  /// this object.
  [[nodiscard]] const char* start(const Intrinsics& camera, const SensorDescription& sensor,
                                  const CaptureSettings& settings, std::span<std::byte> block) noexcept;

  /// Takes a picture in.
  [[nodiscard]] const CaptureStatus& process(const DepthFrame& frame) noexcept;
  /// The same for a view whose pose (camera <- world) is known; the first picture's pose ties the world to
  /// the model.
  [[nodiscard]] const CaptureStatus& process(const DepthFrame& frame,
                                             const RigidTransform& camera_from_world) noexcept;

  /// The same for a view whose pose (camera <- model) is known to a few millimetres and degrees and may be
  /// wrong: aligned from there, and fused only when nearly all of it fits. Otherwise lost, and not counted.
  [[nodiscard]] const CaptureStatus& process_near(const DepthFrame& frame,
                                                  const RigidTransform& camera_from_model) noexcept;

  /// Aligns the kept views to each other and fuses the volume from them anew. Takes as long as some hundred
  /// pictures.
  JointFit finish() noexcept;

  [[nodiscard]] const DistanceVolume& volume() const noexcept { return volume_; }
  [[nodiscard]] const Coverage& coverage() const noexcept { return coverage_; }
  [[nodiscard]] const CaptureFigures& figures() const noexcept { return figures_; }
  [[nodiscard]] const Keyframes& keyframes() const noexcept { return keyframes_; }
  /// Height of the table in the model's frame, metres; lower than the cube without a table.
  [[nodiscard]] double table_height() const noexcept { return table_height_; }

 private:
  /// What is known of a picture's pose beforehand.
  struct GivenPose {
    enum class Kind : std::uint8_t {
      none,
      near,  // camera <- model, to be aligned
      exact  // camera <- world
    };
    Kind kind = Kind::none;
    RigidTransform pose;
  };
  void lay_out(Workspace& workspace, const Intrinsics& camera, const VolumePlan& plan) noexcept;
  const CaptureStatus& judge_picture(const DepthFrame& frame, const GivenPose& given) noexcept;
  [[nodiscard]] bool begin(const GivenPose& given) noexcept;
  [[nodiscard]] bool follow(const GivenPose& given) noexcept;
  void fuse(const DepthFrame& frame) noexcept;
  void keep(const DepthFrame& frame) noexcept;
  [[nodiscard]] ViewAlignSettings align_settings() const noexcept;
  /// Does the shape tell how the view lies, as `fit` has it for `points`?
  void judge_hold(const ViewFit& fit, std::span<const ViewPoint> points) noexcept;

  Intrinsics camera_;
  CaptureSettings settings_;
  VolumePlan plan_;
  Surface surface_;
  Projector projector_;
  BackgroundPlanes background_;
  ObjectCells cells_;
  DistanceVolume volume_;
  ViewFuser fuser_;
  Keyframes keyframes_;
  JointAlignment joint_;
  Coverage coverage_;
  ViewPicture picture_;
  std::span<std::uint16_t> picture_depth_;
  std::span<std::uint8_t> picture_facing_;
  std::span<ViewPoint> points_;
  std::span<PlaneRow> rows_;
  std::int32_t normal_span_ = 0;

  bool begun_ = false;
  bool all_known_ = false;           // every pose so far was given exactly
  RigidTransform world_from_model_;  // of exact poses
  PoseTrail trail_;                  // of the fused pictures
  Standstill standstill_;
  bool was_held_ = false;    // the shape has told once how the view lies
  std::int64_t unheld_ = 0;  // featureless pictures since
  double table_height_ = 0;
  CaptureStatus status_;
  CaptureFigures figures_;
};

}  // namespace pliant

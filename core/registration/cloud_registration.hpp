// One-shot registration of a cloud or a depth picture against the model: the paper in full (section 3),
// without a start pose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"
#include "core/registration/work_sharer.hpp"
#include "core/track_result.hpp"
#include "core/track_settings.hpp"

namespace pliant {

inline constexpr std::uint32_t kMostWorkers = 16;

struct RegistrationSettings {
  std::uint32_t model_keypoints = 2048;  ///< the first so many model points [32, 16384]; descriptors beyond
                                         ///< the stored ones are computed on the fly
  std::uint32_t scene_keypoints =
      2000;                          ///< about so many at first [32, 65535]; raised when matches are too few
  std::uint32_t sampling_steps = 3;  ///< how often the sampling factor may be raised [0, 8]
  std::uint32_t max_regions = 8;     ///< rigid regions of one instance [1, kMaxRegions]
  std::uint32_t max_instances = 1;   ///< instances of the model looked for [1, 32]
  double wanted_share =
      0.98;  ///< of the observed model points explained rigidly: the chain ends there [0.1, 1]
  bool has_viewpoint = false;  ///< normals are turned to `viewpoint`; without, to the origin when all of the
                               ///< scene is in sight from there, else they are made consistent by themselves
  Vector3 viewpoint = Vector3::Zero();  ///< where the sensor stood, scene frame, metres
  Kernels kernels = Kernels::automatic;
  std::uint32_t workers =
      1;              ///< pieces that descriptors and matches of a cloud are cut into [1, kMostWorkers]
  WorkSharer sharer;  ///< who works on them; the result is the same for any number of workers
  // Parts that can be switched off to see what they are worth.
  bool consistent_normals = true;  ///< off: every normal is turned to the viewpoint or the origin
  bool frame_hypotheses = true;    ///< off: poses come from grouping by pairwise distances alone
  bool free_space = true;          ///< off: depth pictures are judged by agreement alone
  bool grouping = true;            ///< off: poses come from single local frames alone
  bool constraints = true;         ///< off: a chain may tear the object apart at its joints
  bool warp = true;        ///< off: deformed points lie where their match lies, the paper's radius search
  bool refinement = true;  ///< off: poses stay as the matches give them
};

/// What a registration found out.
enum class RegistrationOutcome : std::uint8_t {
  found,
  not_found,       ///< the scene does not show the object, or not clearly
  no_points,       ///< the scene has no finite point
  too_few_points,  ///< fewer points than one descriptor takes
  flat,            ///< all points lie on one plane or line: nothing to hold on to
  wrong_size,      ///< the scene is so much larger or smaller than the model that the units differ: see
                   ///< size_ratio
  too_many_points  ///< more points than the workspace was laid out for
};
/// One line for people.
[[nodiscard]] const char* describe(RegistrationOutcome outcome) noexcept;

/// The paper's stages, for time profiles.
enum class RegistrationStage : std::uint8_t {
  normals,
  keypoints,
  descriptors,
  matching,
  grouping,
  chain,
  deformed
};
inline constexpr int kRegistrationStageCount = 7;

/// Told at the end of each piece of work; a stage may come up several times. The core has no clock: the
/// caller stamps. `model_side`: the piece belongs to the model and could have been done beforehand.
struct RegistrationObserver {
  void (*stage_done)(void* context, RegistrationStage stage, bool model_side) = nullptr;
  void* context = nullptr;
};

struct RegionResult {
  std::int8_t id = 0;        ///< 0 is the base: the largest
  std::uint32_t points = 0;  ///< model points that bear its label
  double rms = 0;            ///< of their distances to the scene's surface, metres
  RigidTransform transform;  ///< scene <- model
};

/// One instance of the model. Spans have one entry a model point, in the model's order, and are valid until
/// the next call.
struct InstanceResult {
  double score = 0;  ///< share of the model points that the scene shows where the instance has them, less
                     ///< what speaks against it; at most 1
  std::span<const RegionResult> regions;  ///< base first, then by falling size
  std::uint32_t deformed = 0;             ///< points labelled kDeformed
  std::uint32_t unobserved = 0;           ///< points labelled kNotObserved
  std::span<const Point3f> positions;     ///< scene frame, metres
  std::span<const std::int8_t> labels;    ///< region id, kDeformed or kNotObserved
  std::span<const std::int32_t> matches;  ///< scene point (of a depth picture: pixel v * width + u), -1 none
  std::span<const float> residuals;       ///< distance to the matched point, metres; 0 without a match
};

struct RegistrationResult {
  RegistrationOutcome outcome = RegistrationOutcome::not_found;
  double size_ratio = 1;              ///< scene's extent over the model's
  std::uint32_t model_keypoints = 0;  ///< as used
  std::uint32_t scene_keypoints = 0;
  std::uint64_t work = 0;                     ///< about how many instructions it took; the same everywhere
  std::span<const InstanceResult> instances;  ///< best first
};

struct RegistrationState;
struct SeenInstance;

/// Registers clouds and depth pictures. Allocation-free: all memory is the block given to start(). Not
/// thread-safe.
class CloudRegistration {
 public:
  static constexpr std::size_t kMostInstances = 32;

  /// Bytes of the block that start() needs for scenes of up to `scene_points` points (of a depth picture:
  /// pixels).
  [[nodiscard]] static std::size_t workspace_bytes(const ModelView& model, std::size_t scene_points,
                                                   const RegistrationSettings& settings) noexcept;
  /// Lays out `block` (aligned to Workspace::kAlignment). Null when well, else what is wrong in words.
  /// `model`'s memory and the block must outlive the registration.
  [[nodiscard]] const char* start(const ModelView& model, std::size_t scene_points,
                                  const RegistrationSettings& settings, std::span<std::byte> block) noexcept;
  void observe(const RegistrationObserver& observer) noexcept { observer_ = observer; }

  /// Registers a cloud, metres. Non-finite points are skipped, duplicates do no harm.
  [[nodiscard]] const RegistrationResult& register_cloud(std::span<const Point3f> scene) noexcept;
  /// Registers a depth picture; the scene frame is the camera's.
  [[nodiscard]] const RegistrationResult& register_depth(const DepthFrame& frame, const Intrinsics& camera,
                                                         const SensorDescription& sensor) noexcept;

 private:
  void done(RegistrationStage stage, bool model_side = false) const noexcept;
  /// Thins the scene; false when it is of no use (the outcome says why).
  [[nodiscard]] bool inspect(std::span<const Point3f> scene) noexcept;
  /// Normals of the thinned scene, of which nothing is explained yet.
  void prepare() noexcept;
  /// Chain and deformed points of one instance from its base's pose (scene <- model). False, and no more than
  /// the chain, where that explains less than `least_explained` of the model.
  [[nodiscard]] bool complete(std::size_t number, const RigidTransform& pose, double score,
                              double least_explained = 0) noexcept;
  [[nodiscard]] const RegistrationResult& finish(std::size_t found) noexcept;
  /// The picture's readings as a cloud, NaN where there is none; with instances only what stands around them.
  void read_points(const DepthFrame& frame, const Intrinsics& camera, const SensorDescription& sensor,
                   std::span<const SeenInstance> seen) noexcept;
  /// Instances in a cloud that was seen from one place and is drawn as a picture, by free space.
  [[nodiscard]] std::size_t search_one_view(const DepthFrame& frame, const Intrinsics& camera,
                                            const RigidTransform& scene_from_camera) noexcept;

  RegistrationState* state_ = nullptr;  // inside the block
  RegistrationObserver observer_;
};

}  // namespace pliant

// The buffers of a registration, all inside the caller's block.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/camera/surface.hpp"
#include "core/detect/descriptor_match.hpp"
#include "core/detect/grouping.hpp"
#include "core/detect/point_grid.hpp"
#include "core/detect/shot.hpp"
#include "core/detect/uniform_sampling.hpp"
#include "core/detect/work.hpp"
#include "core/registration/cloud_labels.hpp"
#include "core/registration/cloud_registration.hpp"
#include "core/registration/normal_estimation.hpp"
#include "core/registration/warp_room.hpp"

namespace pliant {

/// The arrays of one instance: slices of shared ones.
struct InstanceBuffers {
  std::span<RegionResult> regions;
  std::span<Point3f> positions;
  std::span<std::int8_t> labels;
  std::span<std::int32_t> matches;
  std::span<float> residuals;
};

struct RegistrationState {
  RegistrationSettings settings;
  ModelView model;
  double support = 0;     ///< of the descriptors, metres
  bool one_view = false;  ///< all of the scene was seen from `eye`
  Vector3 eye = Vector3::Zero();
  double base_spacing = 0;  ///< of the scene as thinned, metres
  double spacing = 0;       ///< the coarser of the model's and the scene's, metres

  // The scene, thinned of duplicates: `base`; a coarser one with normals that carries the descriptors:
  // `working`.
  std::span<Point3f> base;
  std::span<std::uint32_t> base_index;  ///< in the caller's cloud
  std::span<std::uint8_t> base_taken;   ///< explained by an instance
  std::span<Point3f> working;
  std::span<Normal16> working_normals;
  std::span<std::uint8_t> working_taken;
  std::span<float> scratch;
  std::span<std::uint32_t> kept;
  std::size_t base_count = 0, working_count = 0;
  PointGrid base_grid, working_grid;
  UniformSampling sampling;
  NormalOrientation orientation;

  std::span<Point3f> keys;
  std::span<Descriptor> key_descriptors;
  std::span<LocalFrame> key_frames;
  std::size_t key_count = 0;
  std::span<Match> matches;
  std::span<PosedMatch> posed;       ///< all matches
  std::span<PosedMatch> posed_left;  ///< those still unexplained
  std::size_t posed_count = 0;

  std::size_t model_key_count = 0;
  std::span<const Descriptor> model_descriptors;
  std::span<const LocalFrame> model_frames;
  std::span<Descriptor> own_descriptors;  ///< where more are asked for than the model holds
  std::span<LocalFrame> own_frames;
  PointGrid model_grid;   ///< over the model's points, for descriptors
  PointGrid model_index;  ///< the same in cells of the spacing, for nearest points

  std::array<ShotDescriber, kMostWorkers> describers;  ///< one a worker
  DescriptorMatcher matcher;
  std::array<DescriptorMatcher, kMostWorkers> helpers;  ///< the matchers of workers but the first
  std::span<float> key_leans;
  Grouping grouping;
  IslandFilter islands;
  SurfaceReadings readings;
  WarpRoom warp;

  std::span<std::byte> depth_block;   ///< for the search in a picture
  std::span<std::uint16_t> picture;   ///< a cloud drawn as its viewpoint sees it
  std::span<Point3f> picture_points;  ///< vertices of a depth picture, NaN where it has no reading

  // One entry a model point.
  std::span<std::uint16_t> prefix;  ///< 0, 1, 2, …
  std::span<std::uint16_t> part;    ///< points of a region under test
  std::span<std::uint8_t> open;     ///< not explained by a region yet
  std::span<float> off;             ///< how far a point is off the region under test, negative: nothing seen
  std::span<std::uint32_t> gap_nearest;
  std::span<std::uint32_t> proposal;  ///< base point proposed to a deformed point
  std::span<float> along;             ///< distance along the surface to the nearest explained point, metres
  std::span<std::uint16_t> anchor;    ///< that point
  std::span<std::uint32_t> claimed;   ///< per base point: deformed model point + 1

  std::array<InstanceBuffers, CloudRegistration::kMostInstances> buffers;
  std::array<InstanceResult, CloudRegistration::kMostInstances> instances;
  RegistrationResult result;
  mutable std::uint64_t work = 0;  ///< done so far, RegistrationResult::work
};

}  // namespace pliant

// A model, a camera and all the tables of the tracking steps, for tests of single steps.
#pragma once

#include <memory>

#include "core/deform/patch_warp.hpp"
#include "core/track/align.hpp"
#include "core/track/associate.hpp"
#include "core/track/borders.hpp"
#include "core/track/label.hpp"
#include "core/track/model_error.hpp"
#include "core/track/patches.hpp"
#include "core/track/predict.hpp"
#include "core/track/track_state.hpp"
#include "tests/core/synthetic.hpp"

namespace pliant::synthetic {

class TrackScene {
 public:
  explicit TrackScene(const Geometry& body, double spacing = 0.006, const Intrinsics& lens = small_camera())
      : mesh(body), camera(lens), file_(model_of(body, spacing)), model(file_.view()) {
    Workspace measure;
    lay_out(measure);
    memory_ = std::make_unique<OwnedWorkspace>(measure.used());
    lay_out(memory_->get());
    tables.start(model);
    surface.start(camera, SensorDescription());
    projector.start(camera);
    tolerance = {&surface, tables.spacing};
    patches.start(model);
    points.reset();
  }
  TrackScene(const TrackScene&) = delete;
  TrackScene& operator=(const TrackScene&) = delete;

  /// The base region alone, at `pose`.
  void place(const RigidTransform& pose) {
    regions = RegionSet();
    regions[0].alive = true;
    regions[0].pose = regions[0].last_pose = regions[0].predicted = pose;
  }
  void see(Picture& picture) { surface.build(picture.frame(), {0, 0, camera.width, camera.height}); }
  /// The mesh at `pose` before a wall, seen by the surface.
  void see_body(const RigidTransform& pose, double noise = 0) {
    Picture picture(camera);
    picture.draw(mesh, pose);
    picture.wall(1.6);
    if (noise > 0) picture.shake(noise, 11);
    see(picture);
  }
  /// `rounds` of association and alignment, the gate (millimetres) shrinking by a fifth each.
  void align_rounds(int rounds, int gate, bool robust = true) {
    for (int i = 0; i < rounds; ++i, gate = std::max(gate * 4 / 5, 8))
      align_once(gate * kUnitsPerMillimetre, gate * kUnitsPerMillimetre, robust);
  }
  /// The last rounds of a frame: only what fits within half of the inlier limit counts.
  void align_tightly() {
    const std::int32_t limit = tolerance.deformed(depth_of(regions[0].pose, tables.centre));
    for (int i = 0; i < 2; ++i) align_once(3 * limit, limit / 2);
  }
  void align_once(std::int32_t gate, std::int32_t widest, bool robust = true) {
    associate(tables, surface, projector, regions, for_every_region(SearchReach{tables.size, gate}), points);
    AlignSettings align_settings;
    align_settings.widest = for_every_region(widest);
    align_settings.robust = robust;
    (void)align(surface, align_settings, {}, points, regions);
  }
  static WarpSettings warp_settings() {
    WarpSettings settings;
    settings.inward = 24 * kUnitsPerMillimetre;
    settings.outward = 12 * kUnitsPerMillimetre;
    return settings;
  }
  void warp_now(const WarpSettings& settings = warp_settings()) {
    warp_patches(tables, patches, surface, projector, tolerance, regions, settings, points, *warp);
  }
  /// Has all of the warp's patches at `pose`.
  void warp_to(const RigidTransform& pose) {
    warp->reset(pose);
    for (FixedPose& fixed : warp->fixed) fixed = FixedPose(pose, tables.centre);
  }
  /// With a surface that the base region alone moves.
  SightCounts label_now(bool with_memory = true) {
    warp_to(regions[0].pose);
    return look_now(with_memory);
  }
  /// With the surface where the warp has it.
  SightCounts look_now(bool with_memory = true) {
    const RegionBorders borders = region_borders(patches, points.home);
    return label({tables, patches, *warp, surface, projector, tolerance, borders, with_memory}, regions,
                 points);
  }
  [[nodiscard]] Vector3 rest(std::size_t i) const {
    const Point3f& p = model.positions()[i];
    return to_vector(p);
  }
  /// The normal of point i under `pose`, unit but for rounding.
  [[nodiscard]] Vector3 normal(const RigidTransform& pose, std::size_t i) const {
    const FixedPose fixed(pose, tables.centre);
    const IntPoint n = fixed.direction(tables.nx[i], tables.ny[i], tables.nz[i]);
    return Vector3(n.x, n.y, n.z) / 16384;
  }
  /// How far off the model the surface is taken to be at point i, 1/16 mm.
  [[nodiscard]] std::int32_t model_error_at(std::size_t i) const {
    const std::int32_t z = depth_of(regions[0].pose, tables.centre);
    return model_error(points.misfit[i], tolerance.smoothed_noise(z), tolerance.deformed(z));
  }
  /// How far off `truth` the warp of `lanes` puts point i, metres.
  [[nodiscard]] double off(const WarpLanes& lanes, std::size_t i, const Vector3& truth) const {
    const IntPoint p = warped_point(tables, patches, lanes, i);
    return (Vector3(p.x, p.y, p.z) / kUnitsPerMetre - truth).norm();
  }

  Geometry mesh;
  Intrinsics camera;

 private:
  ModelFile file_;
  std::unique_ptr<OwnedWorkspace> memory_;

  void lay_out(Workspace& workspace) {
    tables.lay_out(workspace, model.size());
    surface.lay_out(workspace, camera);
    points.lay_out(workspace, model.size());
  }

 public:
  ModelView model;
  ModelTables tables;
  Surface surface;
  Projector projector;
  Tolerance tolerance;
  PatchTables patches;
  std::unique_ptr<PatchWarp> warp = std::make_unique<PatchWarp>();
  PointState points;
  RegionSet regions;
};

/// Where the bodies stand in these tests.
inline RigidTransform usual_pose() {
  return pose_at({0.02, -0.01, 0.75}, {1, 2, 0.5}, 0.6);
}

}  // namespace pliant::synthetic

// A bar that bends at its middle, followed by the steps of a frame up to the regrouping.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "core/track/regroup.hpp"
#include "tests/core/shared_scene.hpp"

namespace pliant::synthetic {

/// A bar that bends at its middle, seen from its side.
class Hinge : public SharedScene<two_part_bar, 5> {
 protected:
  void SetUp() override {
    scene().points.reset();
    scene().place(pose());
    scene().warp->reset(pose());
    settings_.fewest_points = 40;
  }
  static RigidTransform pose() { return pose_at({0, 0, 0.6}, {1, 0, 0}, 0.4); }
  static Matrix3 bend(double angle) { return turn({0, 1, 0.3}, angle); }

  /// A frame of the bar with its right half turned by `angle` about the hinge; the right of the picture, from
  /// column `hidden_from` on, is hidden by something near. True when regions changed.
  bool frame_at(double angle, double noise = 0.001, int hidden_from = 10000) {
    Picture picture(scene().camera);
    picture.draw(scene().mesh, pose(),
                 [&](const Vector3& p) { return p.x() > 0 ? Vector3(bend(angle) * p) : p; });
    picture.wall(1.5);
    if (hidden_from < scene().camera.width)
      picture.block(hidden_from, 0, scene().camera.width, scene().camera.height, 0.3);
    picture.shake(noise, 3);
    scene().see(picture);
    for (TrackedRegion& region : scene().regions) region.predicted = region.last_pose = region.pose;
    scene().align_rounds(3, 12);
    scene().align_tightly();
    scene().warp_now();
    (void)scene().look_now();
    return regroup_now();
  }
  bool regroup_now() {
    const Sighting sighting(scene().tables, scene().surface, scene().projector, scene().tolerance);
    return regroup({scene().tables, scene().patches, *scene().warp, sighting, scene().tolerance}, settings_,
                   state_, scene().regions, scene().points);
  }
  void bend_to(double from, double to) {
    for (int step = 0; step <= 20; ++step) (void)frame_at(from + (to - from) * step / 20);
  }
  /// The model point farthest to the right (side 1) or left (-1).
  static std::size_t end_of_bar(int side) {
    std::size_t end = 0;
    for (std::size_t i = 0; i < scene().tables.size; ++i)
      if (side * scene().rest(i).x() > side * scene().rest(end).x()) end = i;
    return end;
  }
  static std::int64_t alive() {
    return std::count_if(scene().regions.begin(), scene().regions.end(),
                         [](const TrackedRegion& r) { return r.alive; });
  }

  RegroupSettings settings_;
  RegroupState state_;
};

}  // namespace pliant::synthetic

// Following a rigid model from frame to frame with the Point Cloud Library's projective ICP.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tests/peer/pcl_pipeline.hpp"

namespace peer {

/// One depth picture and its camera; metres = raw / depth_scale.
struct Picture {
  const std::uint16_t* depth = nullptr;
  int width = 0, height = 0, stride = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0, depth_scale = 1000;
};

/// Normals by integral images, correspondences by organised projection, rejection by normals, point-to-plane
/// transforms; of a frame every `step`-th pixel is taken. Rigid only.
class PclTracker {
 public:
  PclTracker(const Points& model, const Points& normals, int step);
  ~PclTracker();
  PclTracker(const PclTracker&) = delete;
  PclTracker& operator=(const PclTracker&) = delete;

  /// camera <- model, row-major.
  void start_from(const std::array<double, 16>& pose);
  /// The pose in the picture, beginning with that of the last one.
  std::array<double, 16> process(const Picture& picture);

 private:
  struct Parts;
  Parts* parts_;
};

}  // namespace peer

// A picture in memory as the frame that the product reads.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"

namespace pliant::test {

/// The picture as a frame; it must outlive it.
inline DepthFrame frame_of(const std::vector<std::uint16_t>& picture, const Intrinsics& camera) {
  DepthFrame frame;
  frame.depth = picture.data();
  frame.width = frame.stride = camera.width;
  frame.height = camera.height;
  return frame;
}

}  // namespace pliant::test

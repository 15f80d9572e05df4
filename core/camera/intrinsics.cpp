#include "core/camera/intrinsics.hpp"

#include "core/limits.hpp"

namespace pliant {

namespace {
bool within(double x, double low, double high) {
  return x >= low && x <= high;
}  // false for NaN

/// Of all pixels of a row or column, by its first and last.
bool slopes_within(int count, double centre, double focal) {
  return within((0 - centre) / focal, -kMostSlope, kMostSlope) &&
         within((count - 1 - centre) / focal, -kMostSlope, kMostSlope);
}
}  // namespace

const char* intrinsics_fault(const Intrinsics& camera) noexcept {
  if (camera.width < limits::kMinFrameWidth || camera.width > limits::kMaxFrameWidth)
    return "width must be 32 to 1920 pixels";
  if (camera.height < limits::kMinFrameHeight || camera.height > limits::kMaxFrameHeight)
    return "height must be 24 to 1200 pixels";
  if (!within(camera.fx, 10, 10000) || !within(camera.fy, 10, 10000))
    return "fx and fy must be 10 to 10000 pixels";
  if (!within(camera.cx, -4000, 8000) || !within(camera.cy, -4000, 8000))
    return "cx and cy must be -4000 to 8000 pixels";
  if (!within(camera.depth_scale, 10, 1000000))
    return "depth_scale must be 10 to 1000000 raw units per metre";
  if (!slopes_within(camera.width, camera.cx, camera.fx) ||
      !slopes_within(camera.height, camera.cy, camera.fy))
    return "(u - cx) / fx and (v - cy) / fy must be -2 to 2 for every pixel (63 degrees from the axis)";
  return nullptr;
}

}  // namespace pliant

// The camera that clouds of single views are drawn for.
#include "drivers/view_files/cloud_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace pliant {
namespace {

/// A wall at 1 m from `from` to `to` aside, as high as wide, a point every `step` metres.
ViewCloud wall(double from, double to, double step) {
  ViewCloud cloud;
  for (double x = from; x <= to; x += step)
    for (double y = from; y <= to; y += step) cloud.emplace_back(x, y, 1);
  return cloud;
}

TEST(CloudPicture, ItsCameraIsOneThatTheCoreTakes) {
  // as wide as a camera may be and wider, ahead and aside, as sparse as fills a small picture
  for (const double from : {-3.0, -2.0, -1.995, -1.5, 0.5, 1.5})
    for (const double to : {1.7, 1.99, 2.0, 3.0})
      for (const double step : {0.01, 0.03, 0.07}) {
        const std::vector<ViewCloud> clouds = {wall(from, to, step)};
        const Intrinsics camera = camera_for(clouds);
        const char* fault = intrinsics_fault(camera);
        EXPECT_EQ(fault, nullptr) << from << " " << to << " " << step << ": " << fault;
        const std::vector<std::uint16_t> depth = draw_cloud(clouds[0], camera);
        EXPECT_NE(std::count(depth.begin(), depth.end(), 8000), 0);
      }
}

TEST(CloudPicture, KeepsPointsInTheMiddle) {
  const std::vector<ViewCloud> clouds = {wall(-0.5, 0.25, 0.01)};
  const Intrinsics camera = camera_for(clouds);
  EXPECT_NEAR(camera.cx - camera.fx * 0.125, 0.5 * (camera.width - 1), 0.6);
  EXPECT_NEAR(camera.cy - camera.fy * 0.125, 0.5 * (camera.height - 1), 0.6);
}

}  // namespace
}  // namespace pliant

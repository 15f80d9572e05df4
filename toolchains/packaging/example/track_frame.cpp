// track_frame MODEL: finds a model in a depth picture with the core alone. The picture is drawn here, from
// the model's own points, 0.7 m before the camera; a driver of yours would bring it from a device.
//
//   pliant model build toy.ply -o toy.model && ./track_frame toy.model
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/memory/workspace.hpp"
#include "core/tracker.hpp"

namespace {

/// Each point as a square as wide as the spacing of the points; the nearest wins.
std::vector<std::uint16_t> draw(const pliant::ModelView& model, const pliant::Intrinsics& camera,
                                double distance) {
  std::vector<std::uint16_t> depth(
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0);
  const pliant::Vector3 centre = model.centre();
  for (std::size_t i = 0; i < model.size(); ++i) {
    const pliant::Point3f& p = model.positions()[i];
    const double x = p.x - centre.x(), y = p.y - centre.y(), z = p.z - centre.z() + distance;
    const int half = static_cast<int>(std::ceil(0.6 * model.spacing() * camera.fx / z));
    const int u = static_cast<int>(camera.fx * x / z + camera.cx),
              v = static_cast<int>(camera.fy * y / z + camera.cy);
    const auto reading = static_cast<std::uint16_t>(z * camera.depth_scale + 0.5);
    for (int b = v - half; b <= v + half; ++b)
      for (int a = u - half; a <= u + half; ++a) {
        if (a < 0 || b < 0 || a >= camera.width || b >= camera.height) continue;
        std::uint16_t& pixel = depth[static_cast<std::size_t>(b) * static_cast<std::size_t>(camera.width) +
                                     static_cast<std::size_t>(a)];
        if (pixel == 0 || reading < pixel) pixel = reading;
      }
  }
  return depth;
}

int fail(const char* what) {
  std::fprintf(stderr, "track_frame: %s\n", what);
  return 2;
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return fail("usage: track_frame MODEL");
  std::ifstream file(words[1], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  pliant::ModelView model;
  if (const pliant::ModelFault fault = pliant::ModelView::open(std::as_bytes(std::span(bytes)), model);
      fault != pliant::ModelFault::none)
    return fail(pliant::describe(fault));

  const pliant::Intrinsics camera{640, 480, 570.3, 570.3, 319.5, 239.5, 1000};
  const pliant::TrackSettings settings;
  // All the memory that tracking will ever use.
  const std::size_t size = pliant::Tracker::workspace_bytes(model, camera, settings);
  const std::size_t whole = (size + pliant::Workspace::kAlignment - 1) / pliant::Workspace::kAlignment *
                            pliant::Workspace::kAlignment;
  auto* block = static_cast<std::byte*>(std::aligned_alloc(pliant::Workspace::kAlignment, whole));
  if (block == nullptr) return fail("not enough memory");
  pliant::Tracker tracker;
  if (const char* fault = tracker.start(model, camera, {}, settings, {block, whole})) return fail(fault);

  const std::vector<std::uint16_t> depth = draw(model, camera, 0.7);
  pliant::DepthFrame frame{depth.data(), camera.width, camera.height, camera.width, 0, 0};
  for (; frame.number < 20; ++frame.number, frame.utime += 33'333) {
    const pliant::TrackResult& result = tracker.process(frame);
    if (result.state != pliant::TrackState::tracking) continue;
    const pliant::Vector3 middle = result.pose.rotation * model.centre() + result.pose.translation;
    std::printf("found in frame %lld: the object's middle is at %.3f %.3f %.3f m\n",
                static_cast<long long>(frame.number), middle.x(), middle.y(), middle.z());
    std::free(block);
    return 0;
  }
  std::free(block);
  return fail("the object was not found");
}

#include "tests/accuracy/plain_placing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pliant {

PlainPlacing::PlainPlacing(const ModelView& model) : rest_(model.positions()) {}

void PlainPlacing::rigid(const TrackResult& result, std::vector<Point3f>& places) {
  std::array<RigidTransform, limits::kMaxRegions> poses;
  poses.fill(result.pose);
  for (const Region& region : result.regions) poses[static_cast<std::size_t>(region.id)] = region.pose;
  rigid_points_.clear();
  for (std::size_t i = 0; i < rest_.size(); ++i)
    if (result.labels[i] >= 0) rigid_points_.push_back(i);
  places.resize(rest_.size());
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    std::int8_t region = result.labels[i];
    double least = std::numeric_limits<double>::max();
    if (region < 0)
      for (const std::size_t j : rigid_points_) {
        const double square = (to_vector(rest_[j]) - to_vector(rest_[i])).squaredNorm();
        if (square >= least) continue;
        least = square;
        region = result.labels[j];
      }
    places[i] =
        to_point(poses[static_cast<std::size_t>(std::max<std::int8_t>(region, 0))] * to_vector(rest_[i]));
  }
}

void PlainPlacing::radius_search(const TrackResult& result, const DepthFrame& frame, const Intrinsics& camera,
                                 double radius, std::vector<Point3f>& places) {
  rigid(result, places);
  taken_.assign(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), false);
  for (std::size_t i = 0; i < rest_.size(); ++i)
    if (result.labels[i] >= 0 && result.matches[i] >= 0)
      taken_[static_cast<std::size_t>(result.matches[i])] = true;
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    if (result.labels[i] != kDeformed) continue;
    const Vector3 at = to_vector(places[i]);
    if (!(at.z() > 0)) continue;
    const auto room = static_cast<int>(std::ceil(radius * camera.fx / at.z()));
    const auto u = static_cast<int>(std::lround(camera.fx * at.x() / at.z() + camera.cx)),
               v = static_cast<int>(std::lround(camera.fy * at.y() / at.z() + camera.cy));
    double least = radius * radius;
    Vector3 nearest = at;
    std::size_t pixel = taken_.size();
    for (int y = std::max(v - room, 0); y <= std::min(v + room, camera.height - 1); ++y)
      for (int x = std::max(u - room, 0); x <= std::min(u + room, camera.width - 1); ++x) {
        const std::uint16_t raw = frame.depth[static_cast<std::ptrdiff_t>(y) * frame.stride + x];
        const auto index = static_cast<std::size_t>(y * camera.width + x);
        if (raw == 0 || taken_[index]) continue;
        const double z = raw / camera.depth_scale;
        const Vector3 reading((x - camera.cx) / camera.fx * z, (y - camera.cy) / camera.fy * z, z);
        const double square = (reading - at).squaredNorm();
        if (square >= least) continue;
        least = square;
        nearest = reading;
        pixel = index;
      }
    if (pixel == taken_.size()) continue;
    taken_[pixel] = true;
    places[i] = to_point(nearest);
  }
}

}  // namespace pliant

#include "drivers/view_files/cloud_picture.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "drivers/model_files/nearest.hpp"

namespace pliant {

namespace {

constexpr double kNearest = 0.05;  // metres; what lies nearer is no reading
constexpr double kPitch = 1.25;    // pixel's width in distances between neighbouring points
constexpr int kMostColumns = 640, kMostRows = 480, kFewest = 64, kBorder = 4;
constexpr double kUnits = 8000;         // a metre, as the core keeps depth
constexpr double kLayer = 0.03;         // of the depth; what lies that much deeper is another surface
constexpr std::size_t kSampled = 2000;  // points whose neighbours tell the spacing

/// Where a point falls on the plane at depth one.
Vector3 on_picture(const Vector3& p) {
  return {p.x() / p.z(), p.y() / p.z(), 0};
}

/// Median distance to the nearest other point as the camera sees it.
double spacing_of(const std::vector<Vector3>& seen) {
  const NearestPoints tree(seen);
  std::vector<double> squares;
  const std::size_t step = std::max<std::size_t>(1, seen.size() / kSampled);
  for (std::size_t i = 0; i < seen.size(); i += step) {
    std::array<std::uint32_t, 2> nearest{};
    std::array<double, 2> square{};
    if (tree.nearest(seen[i], nearest, square) == 2) squares.push_back(square[1]);
  }
  if (squares.empty()) return 0;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return std::sqrt(*middle);
}

/// Points of a cloud that fall into each pixel.
struct Binned {
  std::vector<std::uint32_t> first;  // of each pixel in `points`, and one more
  std::vector<std::uint32_t> points;
};

Binned bin(const ViewCloud& cloud, const std::vector<std::int32_t>& pixel_of, std::size_t pixels) {
  Binned binned;
  binned.first.assign(pixels + 1, 0);
  for (const std::int32_t pixel : pixel_of)
    if (pixel >= 0) ++binned.first[static_cast<std::size_t>(pixel) + 1];
  for (std::size_t i = 0; i < pixels; ++i) binned.first[i + 1] += binned.first[i];
  binned.points.resize(binned.first.back());
  std::vector<std::uint32_t> next(binned.first.begin(), binned.first.end() - 1);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (pixel_of[i] >= 0)
      binned.points[next[static_cast<std::size_t>(pixel_of[i])]++] = static_cast<std::uint32_t>(i);
  return binned;
}

}  // namespace

Intrinsics camera_for(std::span<const ViewCloud> clouds) {
  // tan 63°: a pinhole camera's picture tears at its rim beyond it. A little less, for rounding.
  constexpr double kWidest = 0.995 * kMostSlope;
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9, spacing = 1e9;
  for (const ViewCloud& cloud : clouds) {
    std::vector<Vector3> seen;
    for (const Vector3& p : cloud) {
      if (p.z() < kNearest) continue;
      const Vector3 s = on_picture(p);
      if (std::fabs(s.x()) > kWidest || std::fabs(s.y()) > kWidest) continue;
      seen.push_back(s);
      left = std::min(left, s.x());
      right = std::max(right, s.x());
      top = std::min(top, s.y());
      bottom = std::max(bottom, s.y());
    }
    if (const double own = spacing_of(seen); own > 0) spacing = std::min(spacing, own);
  }
  if (left > right || spacing > 1e8) return {};
  const double focal =
      std::min({1 / (kPitch * spacing), (kMostColumns - 2 * kBorder - 1) / std::max(right - left, 1e-6),
                (kMostRows - 2 * kBorder - 1) / std::max(bottom - top, 1e-6)});
  const auto pixels = [&](double from, double to, int most) {
    return std::clamp(static_cast<int>(std::ceil((to - from) * focal)) + 2 * kBorder + 1, kFewest, most);
  };
  // Nor does what is left free around the points reach beyond it.
  const double rim = kWidest * focal;
  const auto middle = [&](double from, double to, int count) {
    return std::clamp(0.5 * (count - 1) - 0.5 * (from + to) * focal, count - 1 - rim, rim);
  };
  const int most = static_cast<int>(std::min<double>(2 * rim, kMostColumns)) + 1;
  Intrinsics camera;
  camera.width = std::min(pixels(left, right, kMostColumns), most);
  camera.height = std::min(pixels(top, bottom, kMostRows), most);
  camera.fx = camera.fy = focal;
  camera.cx = middle(left, right, camera.width);
  camera.cy = middle(top, bottom, camera.height);
  camera.depth_scale = kUnits;
  return camera;
}

std::vector<std::uint16_t> draw_cloud(const ViewCloud& cloud, const Intrinsics& camera) {
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  struct Place {
    double u = 0, v = 0;
  };
  std::vector<Place> places(cloud.size());
  std::vector<std::int32_t> pixel_of(cloud.size(), -1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3& p = cloud[i];
    if (p.z() < kNearest) continue;
    places[i] = {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
    const double u = std::floor(places[i].u + 0.5), v = std::floor(places[i].v + 0.5);
    if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) continue;
    pixel_of[i] = static_cast<std::int32_t>(v) * camera.width + static_cast<std::int32_t>(u);
  }
  const Binned binned = bin(cloud, pixel_of, width * height);
  std::vector<std::uint16_t> depth(width * height, 0);
  constexpr double kReach = 1.5;  // pixels
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const auto each_near = [&](auto&& take) {
        for (int y = std::max(0, v - 1); y <= std::min(camera.height - 1, v + 1); ++y)
          for (int x = std::max(0, u - 1); x <= std::min(camera.width - 1, u + 1); ++x) {
            const auto at = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            for (std::uint32_t k = binned.first[at]; k < binned.first[at + 1]; ++k) {
              const std::uint32_t i = binned.points[k];
              const double du = places[i].u - u, dv = places[i].v - v;
              if (std::fabs(du) <= kReach && std::fabs(dv) <= kReach) take(cloud[i].z(), du, dv);
            }
          }
      };
      double nearest = std::numeric_limits<double>::infinity();
      each_near([&](double z, double, double) { nearest = std::min(nearest, z); });
      if (nearest == std::numeric_limits<double>::infinity()) continue;
      // The inverse depth of a plane is linear over the picture.
      Matrix3 a = Matrix3::Zero();
      Vector3 b = Vector3::Zero();
      double west = 1, east = -1, north = 1, south = -1;
      each_near([&](double z, double du, double dv) {
        if (z > nearest * (1 + kLayer)) return;
        west = std::min(west, du);
        east = std::max(east, du);
        north = std::min(north, dv);
        south = std::max(south, dv);
        const double weight = 1 / (0.25 + du * du + dv * dv);
        const Vector3 row(1, du, dv);
        a += weight * row * row.transpose();
        b += weight / z * row;
      });
      constexpr double kRim = 0.5;  // half a pixel
      if (west > kRim || east < -kRim || north > kRim || south < -kRim) continue;
      a(1, 1) += 0.05;  // few points say nothing of the slope
      a(2, 2) += 0.05;
      const double z = 1 / a.ldlt().solve(b)(0);
      const double units = std::floor(z * camera.depth_scale + 0.5);
      if (z > nearest * (1 - kLayer) && z < nearest * (1 + 2 * kLayer) && units < 65536)
        depth[static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)] =
            static_cast<std::uint16_t>(units);
    }
  return depth;
}

}  // namespace pliant

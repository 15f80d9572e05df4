#include "drivers/simulated/disparity_image.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::simulated {

namespace {

constexpr double kUnit = static_cast<double>(1 << kDisparityBits);

/// Where the edge between two corners crosses row v. Always reckoned from the upper corner, so that the
/// triangles on its two sides agree to the last bit and leave no gap.
template <typename Corner>
double crossing(const Corner& a, const Corner& b, double v) {
  const bool a_first = a.v < b.v || (!(b.v < a.v) && a.u <= b.u);
  const Corner& p = a_first ? a : b;
  const Corner& q = a_first ? b : a;
  return p.u + (v - p.v) * ((q.u - p.u) / (q.v - p.v));
}

}  // namespace

DisparityImage::DisparityImage(const Intrinsics& camera)
    : camera_(camera),
      pixels_(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0) {
  corners_.reserve(16384);
}

void DisparityImage::clear() {
  std::fill(pixels_.begin(), pixels_.end(), 0);
}

void DisparityImage::draw(std::span<const Vector3> vertices,
                          std::span<const std::array<std::uint32_t, 3>> triangles,
                          std::span<std::uint8_t> facing) {
  corners_.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3& p = vertices[i];
    if (p.z() < kNearest) {
      corners_[i] = {0, 0, 0};
      continue;
    }
    const double inverse = 1 / p.z();
    corners_[i] = {camera_.fx * p.x() * inverse + camera_.cx, camera_.fy * p.y() * inverse + camera_.cy,
                   kFocalBaseline * kUnit * inverse};
  }
  for (const auto& t : triangles) {
    const Corner& a = corners_[t[0]];
    const Corner& b = corners_[t[1]];
    const Corner& c = corners_[t[2]];
    if (a.d <= 0 || b.d <= 0 || c.d <= 0) continue;
    // Counter-clockwise from outside is clockwise in an image whose v points down.
    if ((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u) >= 0) continue;
    if (!facing.empty()) facing[t[0]] = facing[t[1]] = facing[t[2]] = 1;
    draw_triangle(a, b, c);
  }
}

void DisparityImage::draw_triangle(const Corner& a, const Corner& b, const Corner& c) {
  const double low = std::max(std::min({a.v, b.v, c.v}), 0.0);
  const double high = std::min(std::max({a.v, b.v, c.v}), static_cast<double>(camera_.height));
  const double left = std::min({a.u, b.u, c.u});
  const double right = std::max({a.u, b.u, c.u});
  if (!(low < high) || right < 0 || left >= camera_.width) return;
  const double area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
  if (area > -1e-6) return;  // a sliver that covers no pixel; its slopes would not be finite
  const double per_u = ((b.d - a.d) * (c.v - a.v) - (c.d - a.d) * (b.v - a.v)) / area;
  const double per_v = ((c.d - a.d) * (b.u - a.u) - (b.d - a.d) * (c.u - a.u)) / area;
  const auto step = static_cast<std::int64_t>(std::clamp(per_u, -1e12, 1e12));
  const auto least = static_cast<std::int64_t>(std::min({a.d, b.d, c.d}));
  const auto most = static_cast<std::int64_t>(std::max({a.d, b.d, c.d}));
  const Corner* const edges[3][2] = {{&a, &b}, {&b, &c}, {&c, &a}};

  for (int v = static_cast<int>(std::ceil(low)); v < high; ++v) {
    double from = right;
    double to = left;
    for (const auto& edge : edges) {
      const double v0 = edge[0]->v;
      const double v1 = edge[1]->v;
      if ((v0 <= v) == (v1 <= v)) continue;  // the row passes above or below; half open, so no row twice
      const double u = crossing(*edge[0], *edge[1], v);
      from = std::min(from, u);
      to = std::max(to, u);
    }
    const int first = static_cast<int>(std::ceil(std::max(from, 0.0)));
    const int last =
        static_cast<int>(std::ceil(std::min(to, static_cast<double>(camera_.width))));  // not drawn
    if (first >= last) continue;
    auto d =
        static_cast<std::int64_t>(std::clamp(a.d + per_u * (first - a.u) + per_v * (v - a.v), -1e15, 1e15));
    std::int32_t* row = pixels_.data() + static_cast<std::ptrdiff_t>(v) * camera_.width;
    for (int u = first; u < last; ++u, d += step)
      row[u] = std::max(row[u], static_cast<std::int32_t>(std::clamp(d, least, most)));
  }
}

void DisparityImage::draw_plane(const Vector3& normal, double offset,
                                bool (*covers)(const Vector3& in_camera, const void*), const void* context) {
  for (int v = 0; v < camera_.height; ++v) {
    std::int32_t* row = pixels_.data() + static_cast<std::ptrdiff_t>(v) * camera_.width;
    for (int u = 0; u < camera_.width; ++u) {
      const Vector3 ray((u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1);
      const double inverse = normal.dot(ray) / offset;  // 1 / z
      if (!(inverse > 0) || inverse > 1 / kNearest) continue;
      if (!covers(ray / inverse, context)) continue;
      row[u] = std::max(row[u], static_cast<std::int32_t>(kFocalBaseline * kUnit * inverse));
    }
  }
}

bool DisparityImage::sees(const Vector3& vertex, double tolerance) const {
  if (vertex.z() < kNearest) return false;
  const double u = std::floor(camera_.fx * vertex.x() / vertex.z() + camera_.cx + 0.5);
  const double v = std::floor(camera_.fy * vertex.y() / vertex.z() + camera_.cy + 0.5);
  if (!(u >= 0 && v >= 0 && u < camera_.width && v < camera_.height)) return false;
  const double surface = pixels_[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera_.width) +
                                 static_cast<std::size_t>(u)];
  return surface <= kFocalBaseline * kUnit / (vertex.z() - tolerance);
}

}  // namespace pliant::simulated

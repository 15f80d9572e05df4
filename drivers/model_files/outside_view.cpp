#include "drivers/model_files/outside_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pliant {

namespace {

constexpr int kTrianglePixels = 192;  // edge of the picture
constexpr int kMostPointPixels = 256;

/// A picture taken along -towards from far away (no perspective).
class View {
 public:
  View(const Vector3& towards, const Vector3& middle, double radius, int pixels)
      : towards_(towards), middle_(middle), pixels_(pixels), scale_(0.5 * (pixels - 1) / radius) {
    const Vector3 helper = std::fabs(towards.x()) < 0.6 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
    across_ = cross(towards, helper).normalized();
    up_ = cross(towards, across_);
    nearest_.assign(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels),
                    -std::numeric_limits<double>::infinity());
    seen_.assign(nearest_.size(), kNothing);
  }

  /// Pixel coordinates and height towards the viewer.
  [[nodiscard]] Vector3 place(const Vector3& p) const {
    const Vector3 d = p - middle_;
    const double half = 0.5 * (pixels_ - 1);
    return {half + scale_ * across_.dot(d), half + scale_ * up_.dot(d), towards_.dot(d)};
  }
  void put(int x, int y, double height, std::uint32_t what) {
    if (x < 0 || y < 0 || x >= pixels_ || y >= pixels_) return;
    const auto at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels_) + static_cast<std::size_t>(x);
    if (!(height > nearest_[at])) return;
    nearest_[at] = height;
    seen_[at] = what;
  }
  void draw_triangle(const std::array<Vector3, 3>& corners, std::uint32_t what) {
    const auto& [a, b, c] = corners;
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (std::fabs(area) < 1e-9) return;  // seen edge-on
    const int x0 = static_cast<int>(std::ceil(std::min({a.x(), b.x(), c.x()})));
    const int x1 = static_cast<int>(std::floor(std::max({a.x(), b.x(), c.x()})));
    const int y0 = static_cast<int>(std::ceil(std::min({a.y(), b.y(), c.y()})));
    const int y1 = static_cast<int>(std::floor(std::max({a.y(), b.y(), c.y()})));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double v = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
        const double w = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
        if (v >= 0 && w >= 0 && v + w <= 1)
          put(x, y, a.z() + v * (b.z() - a.z()) + w * (c.z() - a.z()), what);
      }
  }
  void draw_disc(const Vector3& at, double radius, std::uint32_t what) {
    for (int y = static_cast<int>(std::ceil(at.y() - radius)); y <= at.y() + radius; ++y)
      for (int x = static_cast<int>(std::ceil(at.x() - radius)); x <= at.x() + radius; ++x)
        if ((x - at.x()) * (x - at.x()) + (y - at.y()) * (y - at.y()) <= radius * radius)
          put(x, y, at.z(), what);
  }
  [[nodiscard]] double scale() const { return scale_; }

  /// Adds the votes of the picture; `facing(what)` is the cosine of its normal to the viewer.
  template <typename Facing>
  void count(std::vector<SideVotes>& votes, Facing facing) const {
    for (const std::uint32_t what : seen_) {
      if (what == kNothing) continue;
      const double cosine = facing(what);
      (cosine > 0 ? votes[what].front : votes[what].back) += std::fabs(cosine);
    }
  }

 private:
  static constexpr std::uint32_t kNothing = 0xFFFFFFFFU;
  Vector3 towards_, middle_, across_, up_;
  int pixels_;
  double scale_;
  std::vector<double> nearest_;
  std::vector<std::uint32_t> seen_;
};

struct Ball {
  Vector3 middle = Vector3::Zero();
  double radius = 0;
};

Ball ball_around(std::span<const Vector3> points) {
  Vector3 lowest = points.front(), highest = lowest;
  for (const Vector3& p : points) {
    lowest = lowest.cwiseMin(p);
    highest = highest.cwiseMax(p);
  }
  Ball ball{0.5 * (lowest + highest), 0};
  for (const Vector3& p : points) ball.radius = std::max(ball.radius, (p - ball.middle).norm());
  return ball;
}

}  // namespace

std::vector<Vector3> view_directions() {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vector3> corners;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g}) {
      corners.emplace_back(0, a, b);
      corners.emplace_back(a, b, 0);
      corners.emplace_back(b, 0, a);
    }
  std::vector<Vector3> directions;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    directions.push_back(corners[i].normalized());
    for (std::size_t j = i + 1; j < corners.size(); ++j)
      if ((corners[i] - corners[j]).squaredNorm() < 4.5)
        directions.push_back((corners[i] + corners[j]).normalized());
  }
  return directions;
}

std::vector<SideVotes> see_triangles(const Mesh& mesh) {
  std::vector<SideVotes> votes(mesh.triangles.size());
  const Ball ball = ball_around(mesh.vertices);
  if (!(ball.radius > 0)) return votes;
  std::vector<Vector3> normals(mesh.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t)
    normals[t] = unit_or_zero(area_vector(mesh, mesh.triangles[t]));
  for (const Vector3& towards : view_directions()) {
    View view(towards, ball.middle, ball.radius, kTrianglePixels);
    for (std::uint32_t t = 0; t < normals.size(); ++t) {
      const Triangle& corners = mesh.triangles[t];
      view.draw_triangle({view.place(mesh.vertices[corners[0]]), view.place(mesh.vertices[corners[1]]),
                          view.place(mesh.vertices[corners[2]])},
                         t);
    }
    view.count(votes, [&](std::uint32_t t) { return normals[t].dot(towards); });
  }
  return votes;
}

std::vector<SideVotes> see_points(const OrientedCloud& cloud, double spacing) {
  std::vector<SideVotes> votes(cloud.points.size());
  const Ball ball = ball_around(cloud.points);
  if (!(ball.radius > 0)) return votes;
  // Two pixels a spacing where the picture can afford it.
  const double wished = 4 * ball.radius / spacing;
  const int pixels = static_cast<int>(std::clamp(wished, 32.0, static_cast<double>(kMostPointPixels)));
  for (const Vector3& towards : view_directions()) {
    View view(towards, ball.middle, ball.radius, pixels);
    for (std::uint32_t i = 0; i < cloud.points.size(); ++i)
      view.draw_disc(view.place(cloud.points[i]), std::max(1.5 * spacing * view.scale(), 1.0), i);
    view.count(votes, [&](std::uint32_t i) { return cloud.normals[i].dot(towards); });
  }
  return votes;
}

double outside_share(const OrientedCloud& cloud, double spacing) {
  SideVotes all;
  for (const SideVotes& votes : see_points(cloud, spacing)) {
    all.front += votes.front;
    all.back += votes.back;
  }
  return all.front + all.back > 0 ? all.front / (all.front + all.back) : 0;
}

}  // namespace pliant

#include "tests/model_files/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace pliant::shapes {

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

Geometry patch(std::size_t columns, std::size_t rows, const std::function<Vector3(double, double)>& place) {
  Geometry geometry;
  for (std::size_t r = 0; r <= rows; ++r)
    for (std::size_t c = 0; c <= columns; ++c)
      geometry.vertices.push_back(to_point(place(static_cast<double>(c) / static_cast<double>(columns),
                                                 static_cast<double>(r) / static_cast<double>(rows))));
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const auto a = static_cast<std::uint32_t>(r * (columns + 1) + c);
      const auto d = static_cast<std::uint32_t>(a + columns + 1);
      geometry.triangles.push_back({a, a + 1, d + 1});
      geometry.triangles.push_back({a, d + 1, d});
    }
  return geometry;
}

Geometry ellipsoid(double a, double b, double c, std::size_t rows) {
  return patch(2 * rows, rows, [&](double s, double t) {
    const double around = 2 * kPi * s, up = kPi * (t - 0.5);
    return Vector3(a * std::cos(up) * std::cos(around), b * std::cos(up) * std::sin(around),
                   c * std::sin(up));
  });
}

Geometry sphere(double radius, std::size_t rows) {
  return ellipsoid(radius, radius, radius, rows);
}

Geometry even_sphere(double radius, std::size_t count) {
  Geometry geometry;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double around = kPi * (3 - std::sqrt(5.0)) * static_cast<double>(i), r = std::sqrt(1 - z * z);
    geometry.vertices.push_back(to_point(radius * Vector3(r * std::cos(around), r * std::sin(around), z)));
  }
  return geometry;
}

Geometry plane(double width, double height, std::size_t rows) {
  return patch(rows, rows, [&](double s, double t) { return Vector3(width * s, height * t, 0); });
}

Geometry cylinder(double radius, double height, std::size_t rows, bool closed) {
  const Geometry wall = patch(3 * rows, rows, [&](double s, double t) {
    return Vector3(radius * std::cos(2 * kPi * s), radius * std::sin(2 * kPi * s), height * (t - 0.5));
  });
  if (!closed) return wall;
  const auto cap = [&](double z, double way) {
    return patch(3 * rows, std::max<std::size_t>(rows / 3, 1), [&](double s, double t) {
      const double angle = way * 2 * kPi * s;
      return Vector3(radius * (1 - t) * std::cos(angle), radius * (1 - t) * std::sin(angle), z);
    });
  };
  return joined(wall, joined(cap(0.5 * height, 1), cap(-0.5 * height, -1)));
}

Geometry side_of_bottle(double degrees, std::size_t rows) {
  return patch(rows, rows, [&](double s, double t) {
    const double angle = degrees * kPi / 180 * (s - 0.5);
    const double narrowing = std::clamp((t - 0.6) / 0.2, 0.0, 1.0);
    const double radius = 0.045 - 0.03 * (0.5 - 0.5 * std::cos(kPi * narrowing));
    return Vector3(0.1 + radius * std::cos(angle), 0.2 + radius * std::sin(angle), 0.26 * t);
  });
}

Geometry angle_bar(std::size_t rows) {
  return patch(rows, rows, [&](double s, double t) {
    return Vector3(s < 0.5 ? 0.1 * (1 - 2 * s) : 0, 0.2 * t, s < 0.5 ? 0 : 0.1 * (2 * s - 1));
  });
}

Geometry torus(double radius, double tube, std::size_t rows) {
  return patch(3 * rows, rows, [&](double s, double t) {
    const double around = 2 * kPi * s, across = 2 * kPi * t;
    const double r = radius + tube * std::cos(across);
    return Vector3(r * std::cos(around), r * std::sin(around), tube * std::sin(across));
  });
}

Geometry box(double x, double y, double z) {
  Geometry geometry;
  for (int i = 0; i < 8; ++i)
    geometry.vertices.push_back(to_point({(i & 1) != 0 ? x : 0, (i & 2) != 0 ? y : 0, (i & 4) != 0 ? z : 0}));
  geometry.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                        {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return geometry;
}

Geometry cushion_with_knob() {
  const auto power = [](double x, double p) { return std::copysign(std::pow(std::fabs(x), p), x); };
  return patch(120, 60, [&](double s, double t) {
    const double around = 2 * kPi * s, up = kPi * (t - 0.5);
    Vector3 p(0.25 * power(std::cos(up), 0.6) * power(std::cos(around), 0.6),
              0.2 * power(std::cos(up), 0.6) * power(std::sin(around), 0.6), 0.06 * power(std::sin(up), 0.8));
    const double x = p.x() - 0.1, y = p.y() - 0.05;
    if (p.z() > 0) p.z() += 0.05 * std::exp(-(x * x + y * y) / 0.002);
    return p;
  });
}

Geometry thin_plate(double width, double thickness, std::size_t rows) {
  const Geometry front =
      patch(rows, rows, [&](double s, double t) { return Vector3(width * s, width * t, thickness); });
  const Geometry back =
      patch(rows, rows, [&](double s, double t) { return Vector3(width * t, width * s, 0); });
  return joined(front, back);
}

Geometry joined(const Geometry& a, const Geometry& b) {
  Geometry both = a;
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) both.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return both;
}

Geometry turned_over(Geometry geometry) {
  for (auto& t : geometry.triangles) std::swap(t[1], t[2]);
  return geometry;
}

Geometry cloud_of(const Geometry& geometry) {
  Geometry cloud;
  cloud.vertices = geometry.vertices;
  cloud.normals = geometry.normals;
  return cloud;
}

Geometry with_noise(Geometry geometry, double amplitude) {
  std::minstd_rand random(7);
  const auto next = [&] {
    return static_cast<float>(amplitude * (2 * static_cast<double>(random()) / std::minstd_rand::max() - 1));
  };
  for (Point3f& p : geometry.vertices) p = {p.x + next(), p.y + next(), p.z + next()};
  return geometry;
}

}  // namespace pliant::shapes

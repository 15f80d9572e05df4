#include "tests/core/synthetic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "core/memory/row_major.hpp"
#include "drivers/model_files/model_builder.hpp"

namespace pliant::synthetic {

namespace {

/// A closed surface over (around, up), placed by `place`; the poles are where up = ∓90°.
Geometry closed_surface(std::size_t columns, std::size_t rows,
                        const std::function<Vector3(double, double)>& place) {
  Geometry g;
  for (std::size_t r = 0; r <= rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const double around = 2 * std::numbers::pi * static_cast<double>(c) / static_cast<double>(columns);
      const double up = std::numbers::pi * (static_cast<double>(r) / static_cast<double>(rows) - 0.5);
      const Vector3 p = place(around, up);
      g.vertices.push_back(to_point(p));
    }
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const auto a = static_cast<std::uint32_t>(r * columns + c);
      const auto b = static_cast<std::uint32_t>(r * columns + (c + 1) % columns);
      const auto up = static_cast<std::uint32_t>(columns);
      g.triangles.push_back({a, b, b + up});
      g.triangles.push_back({a, b + up, a + up});
    }
  return g;
}

double power(double x, double exponent) {
  return std::copysign(std::pow(std::fabs(x), exponent), x);
}

}  // namespace

Intrinsics small_camera() {
  return {320, 240, 290, 290, 159.5, 119.5, 1000};
}

Geometry bumpy_body() {
  return closed_surface(160, 80, [](double around, double up) {
    const double ring = power(std::cos(up), 0.7);
    Vector3 p(0.12 * ring * power(std::cos(around), 0.7), 0.09 * ring * power(std::sin(around), 0.7),
              0.06 * power(std::sin(up), 0.7));
    const double bumps = 0.010 * std::sin(3 * around + 1.0) * std::cos(2 * up) * std::cos(up) +
                         0.008 * std::cos(5 * around) * std::sin(3 * up + 0.5) * std::cos(up);
    return Vector3(p + p.normalized() * bumps);
  });
}

Geometry two_part_bar() {
  return closed_surface(160, 120, [](double around, double up) {
    // long axis x: `up` runs along it
    const double ring = power(std::cos(up), 0.35);
    const double x = 0.16 * std::sin(up) / std::max(std::fabs(std::sin(up)), 0.2) * std::fabs(std::sin(up));
    const double bump = 1 + 0.14 * std::sin(2 * around + 40 * x) + 0.1 * std::cos(3 * around - 25 * x);
    return Vector3(x, 0.05 * ring * bump * power(std::cos(around), 0.7),
                   0.045 * ring * bump * power(std::sin(around), 0.7));
  });
}

ModelFile model_of(const Geometry& geometry, double spacing) {
  ModelBuildSettings settings;
  settings.spacing = spacing;
  Result<BuiltModel> built = build_model(geometry, settings);
  if (!built) throw std::runtime_error(built.error().message);
  Result<ModelFile> file = ModelFile::from_image(std::move(built->image), "synthetic");
  if (!file) throw std::runtime_error(file.error().message);
  return std::move(*file);
}

Matrix3 turn(const Vector3& axis, double angle) {
  const Vector3 half = axis.normalized() * std::sin(0.5 * angle);
  return rotation_from_quaternion({std::cos(0.5 * angle), half.x(), half.y(), half.z()});
}

RigidTransform pose_at(const Vector3& where, const Vector3& axis, double angle) {
  return {turn(axis, angle), where};
}

double degrees_between(const Matrix3& a, const Matrix3& b) {
  // from the difference's norm: exact for small angles, too
  return 2 * std::asin(std::min(1.0, (a - b).norm() / std::sqrt(8.0))) * 180 / std::numbers::pi;
}

Picture::Picture(const Intrinsics& camera)
    : camera_(camera), depth_(table_size(camera.width, camera.height), 0.0) {}

void Picture::draw(const Geometry& mesh, const RigidTransform& pose) {
  draw(mesh, pose, [](const Vector3& p) { return p; });
}

void Picture::draw(const Geometry& mesh, const RigidTransform& pose,
                   const std::function<Vector3(const Vector3&)>& move) {
  std::vector<Vector3> seen;  // u, v, 1/z
  for (const Point3f& vertex : mesh.vertices) {
    const Vector3 p = pose * move(to_vector(vertex));
    seen.emplace_back(camera_.fx * p.x() / p.z() + camera_.cx, camera_.fy * p.y() / p.z() + camera_.cy,
                      1 / p.z());
  }
  for (const auto& triangle : mesh.triangles) {
    const Vector3 &a = seen[triangle[0]], &b = seen[triangle[1]], &c = seen[triangle[2]];
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (std::fabs(area) < 1e-12) continue;
    const int u0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x(), b.x(), c.x()}))));
    const int u1 = std::min(camera_.width - 1, static_cast<int>(std::floor(std::max({a.x(), b.x(), c.x()}))));
    const int v0 = std::max(0, static_cast<int>(std::ceil(std::min({a.y(), b.y(), c.y()}))));
    const int v1 =
        std::min(camera_.height - 1, static_cast<int>(std::floor(std::max({a.y(), b.y(), c.y()}))));
    for (int v = v0; v <= v1; ++v)
      for (int u = u0; u <= u1; ++u) {
        const double wb = ((u - a.x()) * (c.y() - a.y()) - (v - a.y()) * (c.x() - a.x())) / area;
        const double wc = ((b.x() - a.x()) * (v - a.y()) - (b.y() - a.y()) * (u - a.x())) / area;
        if (wb < -1e-9 || wc < -1e-9 || wb + wc > 1 + 1e-9) continue;
        const double z = 1 / ((1 - wb - wc) * a.z() + wb * b.z() + wc * c.z());
        double& old = depth_[row_major(v, camera_.width, u)];
        if (z > 0 && (old == 0 || z < old)) old = z;
      }
  }
}

void Picture::wall(double depth) {
  for (double& z : depth_)
    if (z == 0 || z > depth) z = depth;
}

void Picture::block(int u0, int v0, int u1, int v1, double depth) {
  for (int v = std::max(v0, 0); v < std::min(v1, camera_.height); ++v)
    for (int u = std::max(u0, 0); u < std::min(u1, camera_.width); ++u)
      depth_[row_major(v, camera_.width, u)] = depth;
}

void Picture::shake(double sigma, unsigned seed) {
  std::mt19937 random(seed);
  for (double& z : depth_) {
    // the sum of twelve uniform numbers: the same on every platform
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(random()) / 4294967296.0;
    if (z > 0) z += sigma * sum;
  }
}

DepthFrame Picture::frame(std::int64_t number) {
  raw_.resize(depth_.size());
  for (std::size_t i = 0; i < depth_.size(); ++i)
    raw_[i] = static_cast<std::uint16_t>(std::clamp(depth_[i] * camera_.depth_scale + 0.5, 0.0, 65535.0));
  return {raw_.data(), camera_.width, camera_.height, camera_.width, number * 33333, number};
}

std::span<std::byte> OwnedWorkspace::aligned(std::vector<std::byte>& storage, std::size_t bytes) {
  storage.resize(bytes + Workspace::kAlignment);
  const auto address = reinterpret_cast<std::uintptr_t>(storage.data());
  const std::size_t skip = (Workspace::kAlignment - address % Workspace::kAlignment) % Workspace::kAlignment;
  return std::span(storage).subspan(skip, bytes);
}

OwnedWorkspace::OwnedWorkspace(std::size_t bytes) : workspace_(aligned(storage_, bytes)) {}

}  // namespace pliant::synthetic

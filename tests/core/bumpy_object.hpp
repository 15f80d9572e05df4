// A closed, star-shaped test object without symmetry, its model image, and clouds and depth pictures of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "core/camera/depth_frame.hpp"
#include "core/camera/intrinsics.hpp"
#include "core/detect/shot.hpp"
#include "core/memory/row_major.hpp"
#include "core/model/model_view.hpp"
#include "drivers/model_files/model_image.hpp"
#include "drivers/model_files/spring_network.hpp"

namespace pliant::testing {

/// A caller-owned block aligned for a Workspace.
class AlignedBlock {
 public:
  explicit AlignedBlock(std::size_t size) : raw_(size + Workspace::kAlignment) {
    void* at = raw_.data();
    std::size_t space = raw_.size();
    std::align(Workspace::kAlignment, size, at, space);
    span_ = {static_cast<std::byte*>(at), size};
  }
  [[nodiscard]] std::span<std::byte> span() const { return span_; }

 private:
  std::vector<std::byte> raw_;
  std::span<std::byte> span_;
};

struct TestCloud {
  std::vector<Point3f> positions;
  std::vector<Normal16> normals;
  [[nodiscard]] OrientedPoints view() const { return {positions, normals}; }
};

inline Normal16 normal16(const Vector3& n) {
  const double length = std::sqrt(n.dot(n));
  return {static_cast<std::int16_t>(std::lround(n.x() / length * 16384)),
          static_cast<std::int16_t>(std::lround(n.y() / length * 16384)),
          static_cast<std::int16_t>(std::lround(n.z() / length * 16384)), 0};
}

/// Distance of the surface from the origin in a unit direction, metres: about 0.1, with three lumps and a
/// dent.
inline double bumpy_radius(const Vector3& d) {
  const auto lump = [&](double x, double y, double z, double height, double width) {
    const Vector3 c = Vector3(x, y, z) / std::sqrt(x * x + y * y + z * z);
    const Vector3 gap = d - c;
    return height * std::exp(-gap.dot(gap) / (2 * width * width));
  };
  return 0.09 + 0.02 * d.x() * d.x() - 0.012 * d.z() * d.y() + lump(1, 0.3, 0.2, 0.06, 0.3) +
         lump(-0.4, 1, 0.3, 0.05, 0.25) + lump(-0.2, -0.6, 1, 0.045, 0.35) + lump(0.4, -1, -0.5, -0.03, 0.3);
}

/// `count` points spread over the object (offset shifts them, so that two clouds share no point).
inline TestCloud bumpy_cloud(std::size_t count, double offset = 0) {
  TestCloud cloud;
  const double golden = M_PI * (3 - std::sqrt(5.0));
  const auto at = [](double theta, double z) {
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return Vector3(r * std::cos(theta), r * std::sin(theta), z);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const Vector3 d = at(golden * (static_cast<double>(i) + offset), z);
    const Vector3 a =
        (std::fabs(d.z()) < 0.9 ? Vector3(-d.y(), d.x(), 0) : Vector3(0, -d.z(), d.y())).normalized();
    const Vector3 b(d.y() * a.z() - d.z() * a.y(), d.z() * a.x() - d.x() * a.z(),
                    d.x() * a.y() - d.y() * a.x());
    const auto surface = [](const Vector3& direction) {
      const Vector3 unit = direction.normalized();
      return Vector3(bumpy_radius(unit) * unit);
    };
    const Vector3 p = surface(d), u = surface(d + 1e-4 * a) - p, v = surface(d + 1e-4 * b) - p;
    Vector3 n(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(), u.x() * v.y() - u.y() * v.x());
    if (n.dot(d) < 0) n = -n;
    cloud.positions.push_back(to_point(p));
    cloud.normals.push_back(normal16(n));
  }
  return cloud;
}

inline TestCloud moved(const TestCloud& cloud, const RigidTransform& pose) {
  TestCloud out;
  for (const Point3f& p : cloud.positions) out.positions.push_back(to_point(pose * to_vector(p)));
  for (const Normal16& n : cloud.normals)
    out.normals.push_back(normal16(pose.rotation * Vector3(n.x, n.y, n.z)));
  return out;
}

inline RigidTransform test_pose(double turn, const Vector3& axis, const Vector3& shift) {
  const Vector3 a = axis.normalized() * std::sin(turn / 2);
  return {rotation_from_quaternion({std::cos(turn / 2), a.x(), a.y(), a.z()}), shift};
}

inline double degrees_between(const Matrix3& a, const Matrix3& b) {
  return std::acos(std::clamp(cos_angle(a.transpose() * b), -1.0, 1.0)) * 180 / M_PI;
}

/// A model image of a cloud, in farthest-point order, with everything the header asks for.
class TestModel {
 public:
  explicit TestModel(const TestCloud& cloud, std::size_t keypoints = 1024) : block_(0) {
    const std::size_t n = cloud.positions.size();
    std::vector<std::size_t> order;
    std::vector<double> distance(n, 1e30);
    for (std::size_t at = 0, k = 0; k < n; ++k) {
      order.push_back(at);
      distance[at] = -1;
      std::size_t next = at;
      for (std::size_t i = 0; i < n; ++i) {
        if (distance[i] < 0) continue;
        const Vector3 gap = to_vector(cloud.positions[i]) - to_vector(cloud.positions[at]);
        distance[i] = std::min(distance[i], gap.dot(gap));
        if (next == at || distance[i] > distance[next]) next = i;
      }
      at = next;
    }
    TestCloud sorted;
    for (const std::size_t i : order) {
      sorted.positions.push_back(cloud.positions[i]);
      sorted.normals.push_back(cloud.normals[i]);
    }
    ModelHeader h;
    h.point_count = static_cast<std::uint32_t>(n);
    h.keypoint_count = static_cast<std::uint32_t>(std::min(n, keypoints));
    h.flags = ModelHeader::kCharacterisable | ModelHeader::kClosedSurface;
    h.characterisability = 0.5;
    for (int k = 0; k < 3; ++k) {
      h.lowest[k] = 1e30;
      h.highest[k] = -1e30;
    }
    for (const Point3f& p : sorted.positions)
      for (int k = 0; k < 3; ++k) {
        h.lowest[k] = std::min(h.lowest[k], to_vector(p)(k));
        h.highest[k] = std::max(h.highest[k], to_vector(p)(k));
      }
    for (int k = 0; k < 3; ++k) h.centre[k] = 0.5 * (h.lowest[k] + h.highest[k]);
    for (const Point3f& p : sorted.positions)
      h.radius = std::max(h.radius, (to_vector(p) - Vector3(h.centre[0], h.centre[1], h.centre[2])).norm());
    std::vector<std::uint16_t> neighbours(n * limits::kNeighbours, kNoNeighbour);
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<std::pair<double, std::size_t>> near;
      for (std::size_t j = 0; j < n; ++j) {
        const Vector3 gap = to_vector(sorted.positions[i]) - to_vector(sorted.positions[j]);
        if (j != i) near.emplace_back(gap.dot(gap), j);
      }
      std::partial_sort(near.begin(), near.begin() + limits::kNeighbours, near.end());
      sum += std::sqrt(near[0].first);
      for (std::size_t k = 0; k < limits::kNeighbours; ++k)
        neighbours[i * limits::kNeighbours + k] = static_cast<std::uint16_t>(near[k].second);
    }
    h.spacing = sum / static_cast<double>(n);
    h.support_radius = support_radius_for(h.spacing, h.radius);
    AlignedBlock scratch(n * 64 + (1 << 20));
    Workspace workspace(scratch.span());
    PointGrid grid;
    grid.lay_out(workspace, n);
    static_cast<void>(grid.build(sorted.positions, grid_cell_for_support(h.support_radius)));
    ShotDescriber describer;
    describer.lay_out(workspace);
    std::vector<Descriptor> descriptors(h.keypoint_count);
    std::vector<LocalFrame> frames(h.keypoint_count);
    for (std::size_t i = 0; i < h.keypoint_count; ++i)
      static_cast<void>(
          describer.describe(sorted.view(), grid, i, h.support_radius, descriptors[i], frames[i]));
    const SpringNetwork network = spring_network({sorted.positions,
                                                  sorted.normals,
                                                  neighbours,
                                                  h.spacing,
                                                  {h.centre[0], h.centre[1], h.centre[2]},
                                                  true});
    const std::vector<std::byte> image =
        make_model_image({h, sorted.positions, sorted.normals, neighbours, descriptors, frames, network});
    block_ = AlignedBlock(image.size());
    std::copy(image.begin(), image.end(), block_.span().begin());
    fault_ = ModelView::open(block_.span(), view_);
  }
  [[nodiscard]] const ModelView& view() const { return view_; }
  [[nodiscard]] ModelFault fault() const { return fault_; }

 private:
  AlignedBlock block_;
  ModelView view_;
  ModelFault fault_ = ModelFault::none;
};

/// The model of most tests: 2,500 points.
inline const ModelView& bumpy_model() {
  static const TestModel model(bumpy_cloud(2500));
  return model.view();
}

/// 320×240, 59° wide, millimetres.
inline Intrinsics small_camera() {
  return {320, 240, 285, 285, 160, 120, 1000};
}

/// A depth picture in millimetres of clouds before a wall at `wall` metres: points splatted over `splat`
/// pixels.
inline std::vector<std::uint16_t> depth_picture(const Intrinsics& camera, const TestCloud& cloud, double wall,
                                                int splat, double noise, unsigned seed = 1) {
  std::vector<double> z(table_size(camera.width, camera.height), wall);
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    const Vector3 p = to_vector(cloud.positions[i]);
    const Normal16& n = cloud.normals[i];
    if (n.x * p.x() + n.y * p.y() + n.z * p.z() >= 0) continue;
    const int u = static_cast<int>(std::lround(camera.fx * p.x() / p.z() + camera.cx));
    const int v = static_cast<int>(std::lround(camera.fy * p.y() / p.z() + camera.cy));
    for (int dv = -splat; dv <= splat; ++dv)
      for (int du = -splat; du <= splat; ++du)
        if (u + du >= 0 && v + dv >= 0 && u + du < camera.width && v + dv < camera.height) {
          double& held = z[static_cast<std::size_t>((v + dv) * camera.width + u + du)];
          held = std::min(held, p.z());
        }
  }
  std::mt19937 random(seed);
  std::normal_distribution<double> spread(0, 1);
  std::vector<std::uint16_t> picture;
  for (const double d : z)
    picture.push_back(static_cast<std::uint16_t>(std::lround(1000 * (d + noise * spread(random)))));
  return picture;
}

}  // namespace pliant::testing

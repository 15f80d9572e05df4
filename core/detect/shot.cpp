#include "core/detect/shot.hpp"

#include <cmath>

namespace pliant {

namespace {

constexpr float kQ14 = 16384.0F;
constexpr std::size_t kLanes = ShotBins::kLanes;

std::int16_t to_q14(double x) noexcept {
  return static_cast<std::int16_t>(std::floor(x * static_cast<double>(kQ14) + 0.5));
}

/// The sum of lanes that were added up side by side.
double sum_of(const float (&lanes)[kLanes]) noexcept {
  double sum = 0;
  for (const float lane : lanes) sum += static_cast<double>(lane);
  return sum;
}

}  // namespace

double support_radius_for(double spacing, double model_radius) noexcept {
  // About 110 points of a surface lie within six spacings: enough for the 352 bins to be more than chance.
  // Three tenths of the object's radius see more than a patch that looks like any other, and still less than
  // half of what a single view shows.
  const double by_points = 6 * spacing;
  const double by_shape = 0.3 * model_radius;
  return by_points > by_shape ? by_points : by_shape;
}

void ShotDescriber::lay_out(Workspace& workspace) noexcept {
  constexpr std::size_t kRoom = kMostNeighbours + kLanes;
  for (std::span<float>* array :
       {&support_.x, &support_.y, &support_.z, &support_.distance, &support_.nx, &support_.ny, &support_.nz})
    *array = workspace.take<float>(kRoom);
  support_.index = workspace.take<std::uint32_t>(kRoom);
  bins_.lay_out(workspace, kMostNeighbours);
}

bool ShotDescriber::find_frame(LocalFrame& frame, float (&axes)[9], float* lean) const noexcept {
  const Support& s = support_;
  // z: the mean normal of the inner third, where the surface is most like the keypoint's own. x: where the
  // normals of the support lean to in the plane across z, farther ones counting more: unlike the axes of the
  // covariance it has a sign, and it does not depend on how evenly the points lie. What is turned away from
  // z does not count: a picture that shows the keypoint does not show it.
  float lanes_x[kLanes] = {}, lanes_y[kLanes] = {}, lanes_z[kLanes] = {}, lanes_w[kLanes] = {};
  for (std::size_t k = 0; k < s.count; k += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float part = 1.0F / 3 - s.distance[k + l];
      const float w = part > 0 ? part : 0;
      lanes_x[l] += w * s.nx[k + l];
      lanes_y[l] += w * s.ny[k + l];
      lanes_z[l] += w * s.nz[k + l];
    }
  Vector3 z(sum_of(lanes_x), sum_of(lanes_y), sum_of(lanes_z));
  const double z_length = std::sqrt(z.dot(z));
  if (!(z_length > 1e-6)) return false;
  z /= z_length;
  const auto zx = static_cast<float>(z.x()), zy = static_cast<float>(z.y()), zz = static_cast<float>(z.z());
  for (std::size_t l = 0; l < kLanes; ++l) lanes_x[l] = lanes_y[l] = lanes_z[l] = 0;
  for (std::size_t k = 0; k < s.count; k += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float x = s.x[k + l], y = s.y[k + l], up = s.z[k + l];
      const float height = zx * x + zy * y + zz * up;
      const float across = x * x + y * y + up * up - height * height;
      const float facing = zx * s.nx[k + l] + zy * s.ny[k + l] + zz * s.nz[k + l];
      const float w =
          (facing > 0 ? facing : 0) * (1 - s.distance[k + l]) * std::sqrt(across > 0 ? across : 0);
      lanes_x[l] += w * s.nx[k + l];
      lanes_y[l] += w * s.ny[k + l];
      lanes_z[l] += w * s.nz[k + l];
      lanes_w[l] += w;
    }
  Vector3 x(sum_of(lanes_x), sum_of(lanes_y), sum_of(lanes_z));
  const double weight = sum_of(lanes_w);
  x -= x.dot(z) * z;
  const double x_length = std::sqrt(x.dot(x));
  if (!(x_length > 1e-4 * weight)) return false;
  x /= x_length;
  if (lean != nullptr) *lean = static_cast<float>(x_length / weight);
  const Vector3 y(z.y() * x.z() - z.z() * x.y(), z.z() * x.x() - z.x() * x.z(),
                  z.x() * x.y() - z.y() * x.x());
  for (int i = 0; i < 3; ++i) {
    const auto place = static_cast<std::size_t>(i);
    frame.axes[place] = to_q14(x(i));
    frame.axes[3 + place] = to_q14(y(i));
    frame.axes[6 + place] = to_q14(z(i));
    axes[i] = static_cast<float>(x(i));
    axes[3 + i] = static_cast<float>(y(i));
    axes[6 + i] = static_cast<float>(z(i));
  }
  return true;
}

bool ShotDescriber::describe_at(const OrientedPoints& points, const PointGrid& grid, const Point3f& centre,
                                double support_radius, Descriptor& descriptor, LocalFrame& frame,
                                float* lean) noexcept {
  descriptor.bins.fill(0);
  frame.axes.fill(0);
  Support& s = support_;
  s.count = grid.gather_within(centre, static_cast<float>(support_radius), kMostNeighbours,
                               {s.x.data(), s.y.data(), s.z.data(), s.distance.data(), s.index.data()});
  if (s.count < kLeastNeighbours) return false;
  const std::size_t padded = (s.count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t k = s.count; k < padded; ++k) {
    s.x[k] = s.y[k] = s.z[k] = s.nx[k] = s.ny[k] = s.nz[k] = 0;
    s.distance[k] = static_cast<float>(support_radius * support_radius);
  }
  const auto inverse = static_cast<float>(1.0 / support_radius);
  for (std::size_t k = 0; k < padded; ++k) {
    s.x[k] *= inverse;
    s.y[k] *= inverse;
    s.z[k] *= inverse;
    const float distance = std::sqrt(s.distance[k]) * inverse;
    s.distance[k] = distance < 1 ? distance : 1;
  }
  for (std::size_t k = 0; k < s.count; ++k) {
    const Normal16& n = points.normals[s.index[k]];
    s.nx[k] = static_cast<float>(n.x) * (1 / kQ14);
    s.ny[k] = static_cast<float>(n.y) * (1 / kQ14);
    s.nz[k] = static_cast<float>(n.z) * (1 / kQ14);
  }
  ShotPoints local = {s.x, s.y, s.z, s.distance, s.nx, s.ny, s.nz, s.count, {}};
  return find_frame(frame, local.axes, lean) && bins_.fill(local, descriptor);
}

}  // namespace pliant

#include "core/detect/shot.hpp"

#include <cmath>

namespace pliant {

namespace {

constexpr float kQ14 = 16384.0F;
constexpr int kCosineBins = 11;
constexpr int kAzimuths = 8;

/// Angle of (x, y) in eighths of a turn, [0, 8): atan(t) ~ t·π/4 + 0.273·t·(1 − t), off by less than 0.22°
/// (Rajan et al., Efficient approximations for the arctangent function, IEEE SPM 2006, eq. 9).
float azimuth_of(float x, float y) noexcept {
  const float ax = std::fabs(x), ay = std::fabs(y);
  const float high = ax > ay ? ax : ay;
  if (high == 0) return 0;
  const float t = (ax > ay ? ay : ax) / high;
  float angle = t + 0.3476F * t * (1 - t);
  if (ay > ax) angle = 2 - angle;
  if (x < 0) angle = 4 - angle;
  if (y < 0) angle = 8 - angle;
  return angle < 8 ? angle : 0;
}

float clamp01(float x) noexcept {
  return x < 0 ? 0 : x > 1 ? 1 : x;
}

Vector3 normal_of(const Normal16& n) noexcept {
  return Vector3(n.x, n.y, n.z) / static_cast<double>(kQ14);
}

std::int16_t to_q14(double x) noexcept {
  return static_cast<std::int16_t>(std::floor(x * static_cast<double>(kQ14) + 0.5));
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
  neighbours_ = workspace.take<Neighbour>(kMostNeighbours);
}

bool ShotDescriber::describe_at(const OrientedPoints& points, const PointGrid& grid, const Point3f& centre,
                                double support_radius, Descriptor& descriptor, LocalFrame& frame,
                                float* lean) noexcept {
  descriptor.bins.fill(0);
  frame.axes.fill(0);
  const float inverse = static_cast<float>(1.0 / support_radius);
  std::size_t count = 0;
  grid.visit_within(centre, static_cast<float>(support_radius), kMostNeighbours,
                    [&](std::uint32_t i, const Point3f& p, float square) {
                      neighbours_[count++] = {(p.x - centre.x) * inverse, (p.y - centre.y) * inverse,
                                              (p.z - centre.z) * inverse, std::sqrt(square) * inverse, i};
                    });
  if (count < kLeastNeighbours) return false;

  // z: the mean normal of the inner third, where the surface is most like the keypoint's own. x: where the
  // normals of the support lean to in the plane across z, farther ones counting more: unlike the axes of the
  // covariance it has a sign, and it does not depend on how evenly the points lie.
  Vector3 z = Vector3::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    const double w = 1.0 / 3 - static_cast<double>(neighbours_[k].distance);
    if (w > 0) z += w * normal_of(points.normals[neighbours_[k].index]);
  }
  const double z_length = std::sqrt(z.dot(z));
  if (!(z_length > 1e-6)) return false;
  z /= z_length;
  Vector3 x = Vector3::Zero();
  double weight = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Neighbour& n = neighbours_[k];
    const Vector3 d(static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z));
    const double height = z.dot(d);
    const double across = d.dot(d) - height * height;
    const double w = (1 - static_cast<double>(n.distance)) * std::sqrt(across > 0 ? across : 0);
    x += w * normal_of(points.normals[n.index]);
    weight += w;
  }
  x -= x.dot(z) * z;
  const double x_length = std::sqrt(x.dot(x));
  if (!(x_length > 1e-4 * weight)) return false;
  x /= x_length;
  if (lean != nullptr) *lean = static_cast<float>(x_length / weight);
  const Vector3 y(z.y() * x.z() - z.z() * x.y(), z.z() * x.x() - z.x() * x.z(),
                  z.x() * x.y() - z.y() * x.x());
  for (int i = 0; i < 3; ++i) {
    frame.axes[static_cast<std::size_t>(i)] = to_q14(x(i));
    frame.axes[static_cast<std::size_t>(3 + i)] = to_q14(y(i));
    frame.axes[static_cast<std::size_t>(6 + i)] = to_q14(z(i));
  }

  // Histogram: every neighbour spread over two neighbouring bins of azimuth, elevation, radius and cosine.
  float histogram[kDescriptorSize] = {};
  const float xx = static_cast<float>(x.x()), xy = static_cast<float>(x.y()), xz = static_cast<float>(x.z());
  const float yx = static_cast<float>(y.x()), yy = static_cast<float>(y.y()), yz = static_cast<float>(y.z());
  const float zx = static_cast<float>(z.x()), zy = static_cast<float>(z.y()), zz = static_cast<float>(z.z());
  for (std::size_t k = 0; k < count; ++k) {
    const Neighbour& n = neighbours_[k];
    if (n.distance < 1e-4F) continue;
    const Normal16& normal = points.normals[n.index];
    const float cosine = (zx * static_cast<float>(normal.x) + zy * static_cast<float>(normal.y) +
                          zz * static_cast<float>(normal.z)) /
                         kQ14;
    const float lx = xx * n.x + xy * n.y + xz * n.z;
    const float ly = yx * n.x + yy * n.y + yz * n.z;
    const float lz = zx * n.x + zy * n.y + zz * n.z;

    const float cosine_at = clamp01(0.5F * cosine + 0.5F) * (kCosineBins - 1);
    int cosine_bin = static_cast<int>(cosine_at);
    if (cosine_bin > kCosineBins - 2) cosine_bin = kCosineBins - 2;
    const float cosine_part = cosine_at - static_cast<float>(cosine_bin);

    // Sector centres stand at half-sectors.
    float azimuth_at = azimuth_of(lx, ly) - 0.5F;
    if (azimuth_at < 0) azimuth_at += kAzimuths;
    int azimuth_bin = static_cast<int>(azimuth_at);
    if (azimuth_bin > kAzimuths - 1) azimuth_bin = kAzimuths - 1;
    const float azimuth_part = azimuth_at - static_cast<float>(azimuth_bin);
    const int azimuth_next = azimuth_bin == kAzimuths - 1 ? 0 : azimuth_bin + 1;

    // Elevation centres at ±45°: linear in the sine between them. Radial centres at 1/4 and 3/4.
    const float up = clamp01(0.5F + 0.70710678F * lz / n.distance);
    const float outer = clamp01(2 * n.distance - 0.5F);

    const float azimuth_weights[2] = {1 - azimuth_part, azimuth_part};
    const float elevation_weights[2] = {1 - up, up};
    const float radial_weights[2] = {1 - outer, outer};
    const int azimuth_bins[2] = {azimuth_bin, azimuth_next};
    for (int a = 0; a < 2; ++a)
      for (int e = 0; e < 2; ++e)
        for (int r = 0; r < 2; ++r) {
          const float w = azimuth_weights[a] * elevation_weights[e] * radial_weights[r];
          if (w == 0) continue;
          float* bin = histogram + (azimuth_bins[a] * 4 + e * 2 + r) * kCosineBins + cosine_bin;
          bin[0] += w * (1 - cosine_part);
          bin[1] += w * cosine_part;
        }
  }
  double square = 0;
  for (const float h : histogram) square += static_cast<double>(h) * static_cast<double>(h);
  if (!(square > 0)) return false;
  const double scale = 127.0 / std::sqrt(square);
  for (int i = 0; i < kDescriptorSize; ++i)
    descriptor.bins[static_cast<std::size_t>(i)] =
        static_cast<std::int8_t>(static_cast<double>(histogram[i]) * scale + 0.5);
  return true;
}

}  // namespace pliant

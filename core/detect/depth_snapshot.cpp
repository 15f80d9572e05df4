#include "core/detect/depth_snapshot.hpp"

#include <algorithm>
#include <cmath>

namespace pliant {

namespace {

int reduction(const Intrinsics& camera) noexcept {
  int factor = 1;
  while ((camera.width / factor) * (camera.height / factor) > DepthSnapshot::kMostPixels) ++factor;
  return factor;
}

}  // namespace

Intrinsics reduced_intrinsics(const Intrinsics& camera) noexcept {
  const int n = reduction(camera), middle = n / 2;
  Intrinsics reduced = camera;
  reduced.width = camera.width / n;
  reduced.height = camera.height / n;
  reduced.fx = camera.fx / n;
  reduced.fy = camera.fy / n;
  // Reduced pixel u stands at full pixel n·u + middle.
  reduced.cx = (camera.cx - middle) / n;
  reduced.cy = (camera.cy - middle) / n;
  return reduced;
}

void DepthSnapshot::lay_out(Workspace& workspace, const Intrinsics& camera) noexcept {
  camera_ = reduced_intrinsics(camera);
  depth_ = workspace.take<std::uint16_t>(table_size(width(), height()));
  normals_ = workspace.take<Normal16>(table_size(lattice_width(), lattice_height()));
}

void DepthSnapshot::start(const Intrinsics& camera, const SensorDescription& sensor) noexcept {
  factor_ = reduction(camera);
  camera_ = reduced_intrinsics(camera);
  sensor_ = sensor;
  fx_ = static_cast<float>(camera_.fx);
  fy_ = static_cast<float>(camera_.fy);
  cx_ = static_cast<float>(camera_.cx);
  cy_ = static_cast<float>(camera_.cy);
  inverse_fx_ = static_cast<float>(1.0 / camera_.fx);
  inverse_fy_ = static_cast<float>(1.0 / camera_.fy);
  cx_half_ = cx_ + 0.5F;
  cy_half_ = cy_ + 0.5F;
  width_f_ = static_cast<float>(camera_.width);
  height_f_ = static_cast<float>(camera_.height);
  for (std::uint16_t& d : depth_) d = 0;
  for (Normal16& n : normals_) n = Normal16();
}

void DepthSnapshot::take(const Surface& surface) noexcept {
  std::uint16_t* out = depth_.data();
  for (int v = 0; v < height(); ++v)
    for (int u = 0; u < width(); ++u)
      *out++ = surface.depth(u * factor_ + factor_ / 2, v * factor_ + factor_ / 2);
}

void DepthSnapshot::compute_normals(int first, int last, double metres) noexcept {
  for (int row = std::max(first, 0); row < std::min(last, lattice_height()); ++row)
    for (int column = 0; column < lattice_width(); ++column) {
      Normal16& n = normals_[row_major(row, lattice_width(), column)];
      if (!fit_normal(column * kNormalStep, row * kNormalStep, metres, n)) n = Normal16();
    }
}

void DepthSnapshot::mark_plain(double metres) noexcept {
  constexpr double kAlike = 0.978 * 16384 * 16384;  // cos 12°
  for (int v = 0; v < height(); v += kNormalStep)
    for (int u = 0; u < width(); u += kNormalStep) {
      Normal16& n = normals_[row_major(v / kNormalStep, lattice_width(), u / kNormalStep)];
      if (n.x == 0 && n.y == 0 && n.z == 0) continue;
      const Point3f p = vertex(u, v);
      const double z = static_cast<double>(p.z);
      const int reach = std::clamp(static_cast<int>(metres * camera_.fx / z), 2 * kNormalStep, 60);
      const double off = 16384 * (3 * sensor_.sigma(z) + 0.05 * metres);
      int sides = 0;
      for (int side = 0; side < 4; ++side) {
        const int a = u + (side == 0   ? reach
                           : side == 1 ? -reach
                                       : 0),
                  b = v + (side == 2   ? reach
                           : side == 3 ? -reach
                                       : 0);
        if (a < 0 || b < 0 || a >= width() || b >= height() || depth(a, b) == 0) continue;
        const Normal16& m = normal(a, b);
        if (static_cast<double>(std::int32_t{n.x} * m.x + std::int32_t{n.y} * m.y + std::int32_t{n.z} * m.z) <
            kAlike)
          continue;
        const Point3f q = vertex(a, b);
        const double gap = n.x * static_cast<double>(q.x - p.x) + n.y * static_cast<double>(q.y - p.y) +
                           n.z * static_cast<double>(q.z - p.z);
        if (std::fabs(gap) < off) ++sides;
      }
      n.pad = sides >= 3 ? 1 : 0;
    }
}

bool DepthSnapshot::fit_normal(int u, int v, double metres, Normal16& out) const noexcept {
  const int centre = depth(u, v);
  if (centre == 0) return false;
  const double z = centre * 0.000125;
  const double pixel = z / camera_.fx;
  // At most seven by seven readings, whatever the window.
  const int half = std::clamp(static_cast<int>(metres / pixel + 0.5), 1, 12);
  const int step = (half + 2) / 3;
  const int reach = half / step * step;
  const double slope = kTan75 * pixel * 8000.0;
  const double noise = 4 * sensor_.sigma(z) * 8000.0;
  std::int64_t n = 0, su = 0, sv = 0, sd = 0, suu = 0, suv = 0, svv = 0, sud = 0, svd = 0;
  for (int dv = -reach; dv <= reach; dv += step) {
    if (v + dv < 0 || v + dv >= height()) continue;
    for (int du = -reach; du <= reach; du += step) {
      if (u + du < 0 || u + du >= width()) continue;
      const int d = depth(u + du, v + dv);
      if (d == 0) continue;
      const int distance = std::max(du < 0 ? -du : du, dv < 0 ? -dv : dv);
      const int difference = d - centre;
      const int limit = static_cast<int>(noise + slope * distance);
      if (difference > limit || difference < -limit) continue;
      const std::int64_t x = du, y = dv;
      ++n;
      su += x;
      sv += y;
      sd += difference;
      suu += x * x;
      suv += x * y;
      svv += y * y;
      sud += x * difference;
      svd += y * difference;
    }
  }
  if (n < 6) return false;
  // Centred moments times n: exact integers.
  const auto cuu = static_cast<double>(n * suu - su * su), cuv = static_cast<double>(n * suv - su * sv),
             cvv = static_cast<double>(n * svv - sv * sv), cud = static_cast<double>(n * sud - su * sd),
             cvd = static_cast<double>(n * svd - sv * sd);
  const double determinant = cuu * cvv - cuv * cuv;
  if (!(determinant > 0.02 * cuu * cvv)) return false;
  const double a = (cud * cvv - cvd * cuv) / determinant, b = (cvd * cuu - cud * cuv) / determinant;
  // The tangent plane of z(u, v) seen through the pinhole, turned towards the camera.
  const double nx = a * camera_.fx, ny = b * camera_.fy;
  const double nz = -(centre + a * (u - camera_.cx) + b * (v - camera_.cy));
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (!(length > 0)) return false;
  const double scale = 16384.0 / length;
  out = {static_cast<std::int16_t>(std::floor(nx * scale + 0.5)),
         static_cast<std::int16_t>(std::floor(ny * scale + 0.5)),
         static_cast<std::int16_t>(std::floor(nz * scale + 0.5)), 0};
  return true;
}

}  // namespace pliant

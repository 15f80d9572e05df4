#include "core/camera/surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "core/fixed/integer_root.hpp"
#include "core/limits.hpp"

namespace pliant {

namespace {

constexpr double kTan75 = 3.732;

std::int16_t ray_q14(double slope) {
  return static_cast<std::int16_t>(std::clamp(std::floor(slope * 16384.0 + 0.5), -32767.0, 32767.0));
}

/// 2^15 / n for n = 1 … 9, rounded.
constexpr std::int32_t kReciprocal[10] = {0, 32768, 16384, 10923, 8192, 6554, 5461, 4681, 4096, 3641};

}  // namespace

void Surface::lay_out(Workspace& workspace, const Intrinsics& camera) noexcept {
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  converted_ = workspace.take<std::uint16_t>(width * height);
  cleaned_ = workspace.take<std::uint16_t>(width * height);
  smooth_ = converted_;  // a row of `converted` is spent when its neighbours are cleaned, one row ahead of
                         // smoothing
  ray_x_ = workspace.take<std::int16_t>(width);
  ray_y_ = workspace.take<std::int16_t>(height);
  discontinuity_ = workspace.take<std::uint16_t>(kDepthTableSize);
  sigma_ = workspace.take<std::int32_t>(kDepthTableSize);
}

void Surface::start(const Intrinsics& camera, const SensorDescription& sensor) noexcept {
  camera_ = camera;
  width_ = camera.width;
  height_ = camera.height;
  scale_ = static_cast<std::uint32_t>(kDepthUnitsPerMetre / camera.depth_scale * 65536.0 + 0.5);
  near_ = static_cast<std::uint32_t>(sensor.near_limit * kDepthUnitsPerMetre);
  far_ = static_cast<std::uint32_t>(std::min(sensor.far_limit, limits::kMaxDepth) * kDepthUnitsPerMetre);
  for (int u = 0; u < width_; ++u) ray_x_[static_cast<std::size_t>(u)] = ray_q14((u - camera.cx) / camera.fx);
  for (int v = 0; v < height_; ++v)
    ray_y_[static_cast<std::size_t>(v)] = ray_q14((v - camera.cy) / camera.fy);
  const double pixel = 1.0 / std::min(camera.fx, camera.fy);
  for (int i = 0; i < kDepthTableSize; ++i) {
    const double z = (i + 0.5) * (1 << kDepthTableShift) / kDepthUnitsPerMetre;
    const double limit = 4.0 * sensor.sigma(z) + kTan75 * pixel * z;
    // at most 4095: sums of eight differences stay within 16 bits
    discontinuity_[static_cast<std::size_t>(i)] =
        static_cast<std::uint16_t>(std::min(4095.0, limit * kDepthUnitsPerMetre));
    sigma_[static_cast<std::size_t>(i)] =
        std::max(1, static_cast<std::int32_t>(sensor.sigma(z) * kUnitsPerMetre));
  }
  std::memset(converted_.data(), 0, converted_.size_bytes());
  std::memset(cleaned_.data(), 0, cleaned_.size_bytes());
  window_ = Window();
}

void Surface::convert_row(const std::uint16_t* raw, int v) noexcept {
  std::uint16_t* out = converted_.data() + static_cast<std::ptrdiff_t>(v) * width_;
  const std::uint32_t near = near_, far = far_, scale = scale_;
  for (int u = window_.u0; u < window_.u1; ++u) {
    const std::uint64_t scaled = (std::uint64_t{raw[u]} * scale + 32768U) >> 16;
    out[u] = scaled >= near && scaled <= far ? static_cast<std::uint16_t>(scaled) : std::uint16_t{0};
  }
}

void Surface::clean_row(int v) noexcept {
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(v) * width_;
  const std::uint16_t* in = converted_.data() + row;
  std::uint16_t* out = cleaned_.data() + row;
  const bool border_row = v == window_.v0 || v == window_.v1 - 1;
  for (int u = window_.u0; u < window_.u1; ++u) {
    const std::int32_t z = in[u];
    if (z == 0 || border_row || u == window_.u0 || u == window_.u1 - 1) {
      out[u] = 0;
      continue;
    }
    const std::int32_t limit = discontinuity(static_cast<std::uint16_t>(z));
    int support = 0;
    for (int dv = -1; dv <= 1; ++dv) {
      const std::uint16_t* line = in + static_cast<std::ptrdiff_t>(dv) * width_ + u;
      for (int du = -1; du <= 1; ++du) support += std::abs(line[du] - z) <= limit ? 1 : 0;
    }
    out[u] =
        support > kMinSupport ? static_cast<std::uint16_t>(z) : std::uint16_t{0};  // the pixel counts itself
  }
}

void Surface::smooth_row(int v) noexcept {
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(v) * width_;
  const std::uint16_t* in = cleaned_.data() + row;
  std::uint16_t* out = smooth_.data() + row;
  if (v == window_.v0 || v == window_.v1 - 1) {
    std::memset(out + window_.u0, 0,
                static_cast<std::size_t>(window_.u1 - window_.u0) * sizeof(std::uint16_t));
    return;
  }
  out[window_.u0] = 0;
  out[window_.u1 - 1] = 0;
  for (int u = window_.u0 + 1; u < window_.u1 - 1; ++u) {
    const std::int32_t z = in[u];
    if (z == 0) {
      out[u] = 0;
      continue;
    }
    const std::int32_t limit = discontinuity(static_cast<std::uint16_t>(z));
    std::int32_t sum = 0, count = 0;
    for (int dv = -1; dv <= 1; ++dv) {
      const std::uint16_t* line = in + static_cast<std::ptrdiff_t>(dv) * width_ + u;
      for (int du = -1; du <= 1; ++du) {
        const std::int32_t difference = line[du] - z;
        const bool same = std::abs(difference) <= limit;
        sum += same ? difference : 0;
        count += same ? 1 : 0;
      }
    }
    out[u] = static_cast<std::uint16_t>(z + ((sum * kReciprocal[count] + (1 << 14)) >> 15));
  }
}

void Surface::build(const DepthFrame& frame, Window window) noexcept {
  // What the last window held must not show through.
  for (int v = window_.v0; v < window_.v1; ++v)
    std::memset(smooth_.data() + static_cast<std::ptrdiff_t>(v) * width_ + window_.u0, 0,
                static_cast<std::size_t>(window_.u1 - window_.u0) * sizeof(std::uint16_t));
  window_ = {std::max(window.u0, 0), std::max(window.v0, 0), std::min(window.u1, width_),
             std::min(window.v1, height_)};
  if (window_.u1 - window_.u0 < 3 || window_.v1 - window_.v0 < 3) {
    window_ = Window();
    return;
  }
  for (int v = window_.v0; v < window_.v1; ++v)
    convert_row(frame.depth + static_cast<std::ptrdiff_t>(v) * frame.stride, v);
  for (int v = window_.v0; v < window_.v1; ++v) clean_row(v);
  for (int v = window_.v0; v < window_.v1; ++v) smooth_row(v);
}

int Surface::normal_step(std::uint16_t z8, double metres) const noexcept {
  if (z8 == 0) return 1;
  return std::clamp(static_cast<int>(metres * kDepthUnitsPerMetre * camera_.fx / z8 + 0.5), 1, 8);
}

bool Surface::raw_normal(int u, int v, int step, IntPoint& out) const noexcept {
  const std::uint16_t centre = depth(u, v);
  if (centre == 0) return false;
  const std::int32_t limit = discontinuity(centre) * step;
  const auto usable = [&](int pu, int pv) {
    const std::uint16_t z = depth(pu, pv);
    return z != 0 && std::abs(z - centre) <= limit;
  };
  const bool left = usable(u - step, v), right = usable(u + step, v);
  const bool up = usable(u, v - step), down = usable(u, v + step);
  if (!(left || right) || !(up || down)) return false;
  const auto at = [&](int pu, int pv) { return vertex(pu, pv, depth_at(pu, pv)); };
  const IntPoint a = left ? at(u - step, v) : at(u, v), b = right ? at(u + step, v) : at(u, v);
  const IntPoint c = up ? at(u, v - step) : at(u, v), d = down ? at(u, v + step) : at(u, v);
  const std::int64_t hx = b.x - a.x, hy = b.y - a.y, hz = b.z - a.z;
  const std::int64_t wx = d.x - c.x, wy = d.y - c.y, wz = d.z - c.z;
  // down × right points towards the camera (x right, y down, z forward)
  const std::int64_t nx = wy * hz - wz * hy, ny = wz * hx - wx * hz, nz = wx * hy - wy * hx;
  const std::int64_t largest = std::max({std::abs(nx), std::abs(ny), std::abs(nz)});
  const int bits = 64 - std::countl_zero(static_cast<std::uint64_t>(largest));
  const int shift = std::max(0, bits - 14);
  out = {static_cast<std::int32_t>(nx >> shift), static_cast<std::int32_t>(ny >> shift),
         static_cast<std::int32_t>(nz >> shift)};
  return largest >= 16;
}

bool Surface::normal(int u, int v, int step, Normal16& out) const noexcept {
  IntPoint n;
  if (!raw_normal(u, v, step, n)) return false;
  const auto square = static_cast<std::uint32_t>(n.x * n.x + n.y * n.y + n.z * n.z);
  const auto norm = static_cast<std::int32_t>(integer_sqrt(square));
  if (norm == 0) return false;
  out = {static_cast<std::int16_t>(n.x * 16384 / norm), static_cast<std::int16_t>(n.y * 16384 / norm),
         static_cast<std::int16_t>(n.z * 16384 / norm), 0};
  return true;
}

bool Surface::faces(int u, int v, int step, const IntPoint& direction) const noexcept {
  IntPoint n;
  if (!raw_normal(u, v, step, n)) return true;
  const std::int64_t dot = std::int64_t{n.x} * direction.x + std::int64_t{n.y} * direction.y +
                           std::int64_t{n.z} * direction.z;  // |n| · cos · 2^14
  if (dot <= 0) return false;
  const std::int64_t square = std::int64_t{n.x} * n.x + std::int64_t{n.y} * n.y + std::int64_t{n.z} * n.z;
  const std::int64_t cosine = dot >> 13;  // 2 · |n| · cos
  return cosine * cosine >= square;
}

}  // namespace pliant

#include "core/camera/surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "core/fixed/integer_root.hpp"

namespace pliant {

namespace {

/// |slope| <= kMostSlope, the ends but for their last bit.
std::int16_t ray_q14(double slope) noexcept {
  return static_cast<std::int16_t>(std::clamp(std::floor(slope * 16384.0 + 0.5), -32767.0, 32767.0));
}

std::size_t round_up(std::size_t n) noexcept {
  return (n + kRowSlack - 1) / kRowSlack * kRowSlack;
}

void pass(const std::uint16_t* /*above*/, const std::uint16_t* row, const std::uint16_t* /*below*/,
          std::uint16_t* out, std::size_t count, const DiscontinuityRule& /*rule*/) noexcept {
  std::memcpy(out, row, count * sizeof(std::uint16_t));
}

void clear(std::uint16_t* from, std::size_t count) noexcept {
  std::memset(from, 0, count * sizeof(std::uint16_t));
}

}  // namespace

void Surface::lay_out(Workspace& workspace, const Intrinsics& camera) noexcept {
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  stride_ = round_up(width) + 2 * kMargin;
  smooth_ = workspace.take<std::uint16_t>(stride_ * (height + 2 * static_cast<std::size_t>(kMostStep)));
  normals_ = workspace.take<KeptNormal>(width * height);
  converted_ = workspace.take<std::uint16_t>(stride_ * (kRing + 1));
  cleaned_ = workspace.take<std::uint16_t>(stride_ * kRing);
  ray_x_ = workspace.take<std::int16_t>(width);
  ray_y_ = workspace.take<std::int16_t>(height);
  sigma_ = workspace.take<std::int32_t>(kDepthTableSize);
}

void Surface::start(const Intrinsics& camera, const SensorDescription& sensor, Kernels kernels,
                    bool filtered) noexcept {
  camera_ = camera;
  width_ = camera.width;
  height_ = camera.height;
  rows_ = surface_rows(simd_body(kernels));
  if (!filtered) rows_.clean = rows_.smooth = pass;
  scale_ = DepthScale(camera, sensor);
  rule_ = DiscontinuityRule(camera, sensor);
  focal_x_ = static_cast<std::int32_t>(camera.fx * 256 + 0.5);
  focal_y_ = static_cast<std::int32_t>(camera.fy * 256 + 0.5);
  for (int u = 0; u < width_; ++u) ray_x_[static_cast<std::size_t>(u)] = ray_q14((u - camera.cx) / camera.fx);
  for (int v = 0; v < height_; ++v)
    ray_y_[static_cast<std::size_t>(v)] = ray_q14((v - camera.cy) / camera.fy);
  for (int i = 0; i < kDepthTableSize; ++i) {
    const double z = (i + 0.5) * (1 << kDepthTableShift) / kDepthUnitsPerMetre;
    sigma_[static_cast<std::size_t>(i)] =
        std::max(1, static_cast<std::int32_t>(sensor.sigma(z) * kUnitsPerMetre));
  }
  for (const std::span<std::uint16_t>& buffer : {smooth_, converted_, cleaned_})
    clear(buffer.data(), buffer.size());
  std::fill(normals_.begin(), normals_.end(), KeptNormal());
  picture_key_ = 0;
  picture_ = smooth_.data() + stride_ * static_cast<std::size_t>(kMostStep) + kMargin;
  window_ = Window();
}

void Surface::build(const DepthFrame& frame, Window window) noexcept {
  std::uint16_t* const picture = picture_;
  const auto stride = static_cast<std::ptrdiff_t>(stride_);
  // Kept normals are of older pictures from now on; when their numbers begin anew, they go.
  picture_key_ = static_cast<std::uint16_t>(picture_key_ + kKeyOfPicture);
  if (picture_key_ == 0) {
    std::fill(normals_.begin(), normals_.end(), KeptNormal());
    picture_key_ = kKeyOfPicture;
  }
  // What the last window held must not show through.
  if (!window_.empty())
    for (int v = window_.v0; v < window_.v1; ++v)
      clear(picture + v * stride + window_.u0, static_cast<std::size_t>(window_.u1 - window_.u0));
  window_ = {std::max(window.u0, 0), std::max(window.v0, 0), std::min(window.u1, width_),
             std::min(window.v1, height_)};
  if (window_.empty()) {
    window_ = Window();
    return;
  }
  // Smoothing needs one more clean pixel to each side, cleaning one more reading.
  const Window wide = {std::max(window_.u0 - 2, 0), std::max(window_.v0 - 2, 0),
                       std::min(window_.u1 + 2, width_), std::min(window_.v1 + 2, height_)};
  const auto wide_count = static_cast<std::size_t>(wide.u1 - wide.u0);
  const auto count = static_cast<std::size_t>(window_.u1 - window_.u0);
  const std::uint16_t* const nothing = converted_.data() + stride_ * kRing + kMargin;
  const auto ring = [&](std::span<std::uint16_t> rows, int v) {
    return rows.data() + stride_ * (static_cast<std::size_t>(v) % kRing) + kMargin;
  };
  const auto row_of = [&](std::span<std::uint16_t> rows, int v) -> const std::uint16_t* {
    return v < wide.v0 || v >= wide.v1 ? nothing : ring(rows, v);
  };
  // One row after the other through the three stages, each a row behind the one before.
  for (int v = wide.v0; v < wide.v1 + 2; ++v) {
    if (v < wide.v1) {
      std::uint16_t* out = ring(converted_, v);
      rows_.convert(frame.depth + static_cast<std::ptrdiff_t>(v) * frame.stride + wide.u0, out, wide_count,
                    scale_);
      clear(out + wide_count, kMargin);
    }
    if (v - 1 >= wide.v0 && v - 1 < wide.v1) {
      std::uint16_t* out = ring(cleaned_, v - 1);
      rows_.clean(row_of(converted_, v - 2), row_of(converted_, v - 1), row_of(converted_, v), out,
                  wide_count, rule_);
      clear(out + wide_count, kMargin);
    }
    if (v - 2 >= window_.v0 && v - 2 < window_.v1) {
      std::uint16_t* out = picture + (v - 2) * stride + window_.u0;
      const std::ptrdiff_t inset = window_.u0 - wide.u0;
      rows_.smooth(row_of(cleaned_, v - 3) + inset, row_of(cleaned_, v - 2) + inset,
                   row_of(cleaned_, v - 1) + inset, out, count, rule_);
      clear(out + count, kRowSlack);
    }
  }
}

PixelSpan Surface::pixel_span(double metres) const noexcept {
  return {static_cast<std::int32_t>(std::clamp(metres * kDepthUnitsPerMetre * camera_.fx, 0.0, 1e9))};
}

Surface::KeptNormal Surface::take_normal(int u, int v, int step) const noexcept {
  KeptNormal out;
  out.key = static_cast<std::uint16_t>(picture_key_ + step);
  const std::uint16_t* const here = at(u, v);
  const std::int32_t z = *here;
  if (z == 0) return out;
  const std::int32_t limit = rule_.limit(static_cast<std::uint16_t>(z)) * step;
  const std::ptrdiff_t down = static_cast<std::ptrdiff_t>(stride_) * step;
  // Difference over `sides` steps along one axis; 0 sides where neither neighbour is of this surface.
  struct Slope {
    std::int32_t difference = 0, sides = 0;
  };
  const auto slope = [&](std::ptrdiff_t offset) {
    const std::int32_t before = here[-offset], after = here[offset];
    Slope s;
    if (after != 0 && std::abs(after - z) <= limit) {
      s.difference += after - z;
      ++s.sides;
    }
    if (before != 0 && std::abs(before - z) <= limit) {
      s.difference += z - before;
      ++s.sides;
    }
    return s;
  };
  const Slope across = slope(step), along = slope(down);
  if (across.sides == 0 || along.sides == 0) return out;
  // The tangent plane of z(u, v) seen through the pinhole: (f·dz/du, f·dz/dv, -(z + f·dz/du·x + f·dz/dv·y))
  // with the ray (x, y, 1), times `steps` = 2 · step pixels, in Q4. Bounds: a difference over two steps is
  // below 4095 · 16 = 2^16, f·dz below 2^16 · 10000 · 2^4 = 2^33.3, the sum below 2^35.4.
  const auto scaled = [](const Slope& s, std::int32_t focal) {
    return (static_cast<std::int64_t>(s.difference) * (s.sides == 1 ? 2 : 1) * focal) >> 4;
  };
  const std::int64_t nx = scaled(across, focal_x_), ny = scaled(along, focal_y_);
  const std::int64_t nz =
      -((2 * static_cast<std::int64_t>(z) * step << 4) +
        ((nx * ray_x_[static_cast<std::size_t>(u)] + ny * ray_y_[static_cast<std::size_t>(v)]) >> 14));
  const std::int64_t largest = std::abs(nx) | std::abs(ny) | std::abs(nz);
  const int bits = 64 - std::countl_zero(static_cast<std::uint64_t>(largest));
  const int shift = bits > 14 ? bits - 14 : 0;
  out.x = static_cast<std::int16_t>(nx >> shift);
  out.y = static_cast<std::int16_t>(ny >> shift);
  out.z = static_cast<std::int16_t>(nz >> shift);
  return out;
}

bool Surface::normal(int u, int v, int step, Normal16& out) const noexcept {
  const KeptNormal& n = raw_normal(u, v, step);
  const auto square = static_cast<std::uint32_t>(n.x * n.x + n.y * n.y + n.z * n.z);
  const auto norm = static_cast<std::int32_t>(integer_sqrt(square));
  if (norm == 0) return false;
  out = {static_cast<std::int16_t>(n.x * 16384 / norm), static_cast<std::int16_t>(n.y * 16384 / norm),
         static_cast<std::int16_t>(n.z * 16384 / norm), 0};
  return true;
}

}  // namespace pliant

#include "core/camera/surface_rows.hpp"

#include <algorithm>
#include <cmath>

#include "core/camera/surface.hpp"
#include "core/limits.hpp"

namespace pliant {

namespace {

std::uint16_t rounded(double x, double most) noexcept {
  return static_cast<std::uint16_t>(std::clamp(std::floor(x + 0.5), 0.0, most));
}

/// The first reading that gives at least `depth`, at most 2^16.
std::uint32_t first_reading(const DepthScale& scale, std::uint64_t depth) noexcept {
  const std::uint64_t least =
      (depth << scale.shift) - std::min<std::uint64_t>(depth << scale.shift, scale.half);
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>((least + scale.multiplier - 1) / scale.multiplier, 65536));
}

}  // namespace

DepthScale::DepthScale(const Intrinsics& camera, const SensorDescription& sensor) noexcept {
  // As many bits of the factor as fit.
  const double factor = kDepthUnitsPerMetre / camera.depth_scale;
  double scaled = factor;
  while (shift < 17 && scaled * 2 < 65535.0) {
    scaled *= 2;
    ++shift;
  }
  multiplier = std::max<std::uint16_t>(rounded(scaled, 65535), 1);
  half = shift == 0 ? 0 : 1U << (shift - 1);
  const double far = std::min(sensor.far_limit, limits::kMaxDepth);
  const std::uint32_t low =
      first_reading(*this, static_cast<std::uint64_t>(sensor.near_limit * kDepthUnitsPerMetre));
  const std::uint32_t high = first_reading(*this, static_cast<std::uint64_t>(far * kDepthUnitsPerMetre) + 1);
  first = static_cast<std::uint16_t>(std::clamp<std::uint32_t>(low, 1, 65535));
  last = static_cast<std::uint16_t>(low > 65535 ? 0 : high - 1);
}

DiscontinuityRule::DiscontinuityRule(const Intrinsics& camera, const SensorDescription& sensor) noexcept {
  base = rounded(4 * sensor.noise_floor * kDepthUnitsPerMetre, kMost);
  slope = rounded(kTan75 / std::min(camera.fx, camera.fy) * 65536.0, 65535);
  // 4 σ grows by 4 g (units / 8000)² · 8000 = g · 4 · 2^16 / 8000 a squared depth of 2^16
  double scaled = 4 * sensor.noise_growth * 65536.0 / kDepthUnitsPerMetre * 65536.0;
  while (scaled > 65535.0 && growth_shift < 3) {
    scaled /= 2;
    ++growth_shift;
  }
  growth = rounded(scaled, 65535);
}

const SurfaceRows& surface_rows(SimdBody body) noexcept {
#if defined(__x86_64__) || defined(__i386__)
  if (body == SimdBody::avx2) return kSurfaceRowsAvx2;
  if (body == SimdBody::sse41) return kSurfaceRowsSse41;
#elif defined(__aarch64__) || defined(__arm__)
  if (body == SimdBody::neon) return kSurfaceRowsNeon;
#else
  static_cast<void>(body);
#endif
  return kSurfaceRowsScalar;
}

}  // namespace pliant

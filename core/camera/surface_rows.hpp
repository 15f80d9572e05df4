// The three passes over the rows of a depth picture that make a surface of it: convert, clean, smooth.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/simd/cpu.hpp"

namespace pliant {

/// Raw readings to depth units of 1/8 mm: (raw · multiplier + half) >> shift for raw in [first, last], else
/// 0. Overflow bound: multiplier < 2^16 and shift <= 17, so that the sum stays below 2^32; readings up to
/// `last` give at most 64000 (8 m).
struct DepthScale {
  std::uint16_t multiplier = 0;
  std::uint16_t first = 1, last = 0;  ///< raw readings within the sensor's range
  std::uint32_t half = 0;
  int shift = 0;

  DepthScale() noexcept = default;
  DepthScale(const Intrinsics& camera, const SensorDescription& sensor) noexcept;
};

inline constexpr double kTan75 = 3.732;  ///< the steepest slope that counts as one surface

/// The largest depth difference between neighbouring pixels of one surface: 4 σ of the sensor plus a slope of
/// 75° over one pixel, in 1/8 mm, as an integer quadratic function of the depth.
/// Formats: base 1/8 mm, slope Q16, growth Q(16 - growth_shift) a squared depth of 2^16 units. The result is
/// at most 4095, so that sums of eight differences stay within 16 bits, and below the depth itself, so that a
/// missing reading (0) is never near one.
struct DiscontinuityRule {
  static constexpr std::uint16_t kMost = 4095;
  static constexpr std::uint16_t kNoiseCentre = 3200;  ///< where SensorDescription's noise is least, 0.4 m

  std::uint16_t base = 0, slope = 0, growth = 0;
  int growth_shift = 0;

  DiscontinuityRule() noexcept = default;
  DiscontinuityRule(const Intrinsics& camera, const SensorDescription& sensor) noexcept;

  [[nodiscard]] std::uint16_t limit(std::uint16_t z8) const noexcept {
    const std::uint32_t z = z8, off = z > kNoiseCentre ? z - kNoiseCentre : kNoiseCentre - z;
    const std::uint32_t noise = (((off * off) >> 16) * growth) >> 16;
    const std::uint32_t sum =
        base + ((z * slope) >> 16) + ((noise < kMost ? noise : std::uint32_t{kMost}) << growth_shift);
    const std::uint32_t below = z == 0 ? 0 : z - 1, most = sum < kMost ? sum : std::uint32_t{kMost};
    return static_cast<std::uint16_t>(most < below ? most : below);
  }
};

/// Neighbours within the limit that a reading needs to be no flying pixel.
inline constexpr int kMinSupport = 3;

/// Bodies may write up to so many items beyond a row's count, and read one item more than that, and one
/// before its first.
inline constexpr std::size_t kRowSlack = 16;

/// `out`[i] = depth of `raw`[i]. Reads no raw item beyond `count`.
using ConvertRow = void (*)(const std::uint16_t* raw, std::uint16_t* out, std::size_t count,
                            const DepthScale& scale) noexcept;
/// From a row and its neighbours.
/// Clean: a reading stays when kMinSupport of its eight neighbours lie within its limit.
/// Smooth: a reading becomes the mean over those of its 3×3 neighbourhood that lie within its limit:
/// z + (sum of differences · 2^15 / number + 2^14) >> 15, exact to half a unit plus 1/8.
using FilterRow = void (*)(const std::uint16_t* above, const std::uint16_t* row, const std::uint16_t* below,
                           std::uint16_t* out, std::size_t count, const DiscontinuityRule& rule) noexcept;

struct SurfaceRows {
  ConvertRow convert = nullptr;
  FilterRow clean = nullptr;
  FilterRow smooth = nullptr;
};

/// Of a mean over n = 2 … 9 readings: 2^15 / n, rounded.
inline constexpr std::uint16_t kMeanReciprocal[8] = {16384, 10923, 8192, 6554, 5461, 4681, 4096, 3641};

/// All bodies give the same bits. Only those of the architecture are there.
extern const SurfaceRows kSurfaceRowsScalar, kSurfaceRowsSse41, kSurfaceRowsAvx2, kSurfaceRowsNeon;
[[nodiscard]] const SurfaceRows& surface_rows(SimdBody body) noexcept;

}  // namespace pliant

// A point that several integer poses move, its coordinates side by side in a vector where every processor of
// the architecture has one (SSE2, 64-bit NEON), else one after the other. All give the bits of
// FixedPose::point().
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include <array>
#include <cstdint>

#include "core/track/model_tables.hpp"

namespace pliant {

#if defined(__SSE2__)

/// A pose as products of 16 bits take it, whose pairs are added: rows (r0 r1), and (r2 8192) to round.
struct PoseLanes {
  __m128i xy, z, t;

  PoseLanes() noexcept = default;
  explicit PoseLanes(const FixedPose& pose) noexcept
      : xy(_mm_setr_epi32(pair(pose.r[0], pose.r[1]), pair(pose.r[3], pose.r[4]), pair(pose.r[6], pose.r[7]),
                          0)),
        z(_mm_setr_epi32(pair(pose.r[2], 8192), pair(pose.r[5], 8192), pair(pose.r[8], 8192), 0)),
        t(_mm_setr_epi32(pose.t[0], pose.t[1], pose.t[2], 0)) {}

  static std::int32_t pair(std::int32_t low, std::int32_t high) noexcept {
    return static_cast<std::int32_t>((static_cast<std::uint32_t>(high) << 16) |
                                     (static_cast<std::uint32_t>(low) & 0xFFFF));
  }
};

/// The sum of weight · (pose · point), from `start` on each axis. Weights in [0, 2^15), the sum within 32
/// bits.
class PointSum {
 public:
  PointSum(std::int16_t x, std::int16_t y, std::int16_t z, std::int32_t start) noexcept
      : xy_(_mm_set1_epi32(PoseLanes::pair(x, y))),
        z_(_mm_set1_epi32(PoseLanes::pair(z, 1))),
        sum_(_mm_set1_epi32(start)) {}

  void add(const PoseLanes& pose, std::int32_t weight) noexcept {
    const __m128i turned =
        _mm_srai_epi32(_mm_add_epi32(_mm_madd_epi16(pose.xy, xy_), _mm_madd_epi16(pose.z, z_)), 14);
    const __m128i point = _mm_add_epi32(turned, pose.t);
    // 32 bits times 16: the products of both halves, and what the lower one carries into the upper
    const __m128i w = _mm_set1_epi16(static_cast<std::int16_t>(weight));
    const __m128i carry = _mm_slli_epi32(_mm_mulhi_epu16(point, w), 16);
    sum_ = _mm_add_epi32(sum_, _mm_add_epi32(_mm_mullo_epi16(point, w), carry));
  }
  /// The sum over 2^shift, rounded down.
  [[nodiscard]] IntPoint over(int shift) const noexcept {
    alignas(16) std::array<std::int32_t, 4> out;
    _mm_store_si128(static_cast<__m128i*>(static_cast<void*>(out.data())),
                    _mm_sra_epi32(sum_, _mm_cvtsi32_si128(shift)));
    return {out[0], out[1], out[2]};
  }

 private:
  __m128i xy_, z_, sum_;
};

#elif defined(__aarch64__)

struct PoseLanes {
  int32x4_t x, y, z, t;  // columns

  PoseLanes() noexcept = default;
  explicit PoseLanes(const FixedPose& pose) noexcept
      : x{pose.r[0], pose.r[3], pose.r[6], 0},
        y{pose.r[1], pose.r[4], pose.r[7], 0},
        z{pose.r[2], pose.r[5], pose.r[8], 0},
        t{pose.t[0], pose.t[1], pose.t[2], 0} {}
};

class PointSum {
 public:
  PointSum(std::int16_t x, std::int16_t y, std::int16_t z, std::int32_t start) noexcept
      : x_(vdupq_n_s32(x)), y_(vdupq_n_s32(y)), z_(vdupq_n_s32(z)), sum_(vdupq_n_s32(start)) {}

  void add(const PoseLanes& pose, std::int32_t weight) noexcept {
    const int32x4_t turned = vmlaq_s32(vmlaq_s32(vmulq_s32(pose.x, x_), pose.y, y_), pose.z, z_);
    sum_ = vmlaq_n_s32(sum_, vaddq_s32(vrshrq_n_s32(turned, 14), pose.t), weight);
  }
  [[nodiscard]] IntPoint over(int shift) const noexcept {
    const int32x4_t out = vshlq_s32(sum_, vdupq_n_s32(-shift));
    return {vgetq_lane_s32(out, 0), vgetq_lane_s32(out, 1), vgetq_lane_s32(out, 2)};
  }

 private:
  int32x4_t x_, y_, z_, sum_;
};

#else

struct PoseLanes {
  FixedPose pose;

  PoseLanes() noexcept = default;
  explicit PoseLanes(const FixedPose& from) noexcept : pose(from) {}
};

class PointSum {
 public:
  PointSum(std::int16_t x, std::int16_t y, std::int16_t z, std::int32_t start) noexcept
      : x_(x), y_(y), z_(z), sum_{start, start, start} {}

  void add(const PoseLanes& lanes, std::int32_t weight) noexcept {
    const IntPoint p = lanes.pose.point(x_, y_, z_);
    sum_ = {sum_.x + weight * p.x, sum_.y + weight * p.y, sum_.z + weight * p.z};
  }
  [[nodiscard]] IntPoint over(int shift) const noexcept {
    return {sum_.x >> shift, sum_.y >> shift, sum_.z >> shift};
  }

 private:
  std::int32_t x_, y_, z_;
  IntPoint sum_;
};

#endif

}  // namespace pliant

// Eight unsigned 16-bit lanes in NEON (ARMv7 and ARMv8); operations as in lanes_sse41.hpp.
#pragma once

#include <arm_neon.h>

#include <cstddef>
#include <cstdint>

namespace pliant {

struct LanesNeon {
  using Lanes = uint16x8_t;
  static constexpr std::size_t kCount = 8;
  struct Band {
    Lanes z, limit;
  };

  static Lanes load(const std::uint16_t* from) noexcept { return vld1q_u16(from); }
  static void store(std::uint16_t* to, Lanes a) noexcept { vst1q_u16(to, a); }
  static Lanes all(std::uint16_t x) noexcept { return vdupq_n_u16(x); }
  static Lanes zero() noexcept { return vdupq_n_u16(0); }
  static Lanes add(Lanes a, Lanes b) noexcept { return vaddq_u16(a, b); }
  static Lanes subtract(Lanes a, Lanes b) noexcept { return vsubq_u16(a, b); }
  static Lanes add_saturated(Lanes a, Lanes b) noexcept { return vqaddq_u16(a, b); }
  static Lanes subtract_saturated(Lanes a, Lanes b) noexcept { return vqsubq_u16(a, b); }
  static Lanes lesser(Lanes a, Lanes b) noexcept { return vminq_u16(a, b); }
  static Lanes both(Lanes a, Lanes b) noexcept { return vandq_u16(a, b); }
  static Lanes distance(Lanes a, Lanes b) noexcept { return vabdq_u16(a, b); }
  static Lanes low_product(Lanes a, Lanes b) noexcept { return vmulq_u16(a, b); }
  static Lanes high_product(Lanes a, Lanes b) noexcept {
    return vcombine_u16(vshrn_n_u32(vmull_u16(vget_low_u16(a), vget_low_u16(b)), 16),
                        vshrn_n_u32(vmull_u16(vget_high_u16(a), vget_high_u16(b)), 16));
  }
  static Lanes rounded_product(Lanes a, Lanes b) noexcept {
    return vreinterpretq_u16_s16(vqrdmulhq_s16(vreinterpretq_s16_u16(a), vreinterpretq_s16_u16(b)));
  }
  static Lanes shift_left(Lanes a, int bits) noexcept {
    return vshlq_u16(a, vdupq_n_s16(static_cast<std::int16_t>(bits)));
  }
  static Lanes at_most(Lanes a, Lanes b) noexcept { return vcleq_u16(a, b); }
  static Band band(Lanes z, Lanes limit) noexcept { return {z, limit}; }
  static Lanes inside(Lanes a, const Band& b) noexcept { return vcleq_u16(vabdq_u16(a, b.z), b.limit); }
  static Lanes scale(Lanes a, std::uint16_t multiplier, std::uint32_t half, int shift) noexcept {
    const uint16x4_t m = vdup_n_u16(multiplier);
    const uint32x4_t h = vdupq_n_u32(half);
    const int32x4_t s = vdupq_n_s32(-shift);
    return vcombine_u16(vmovn_u32(vshlq_u32(vmlal_u16(h, vget_low_u16(a), m), s)),
                        vmovn_u32(vshlq_u32(vmlal_u16(h, vget_high_u16(a), m), s)));
  }
  static Lanes look_up(const std::uint16_t* table, Lanes a) noexcept {
    const uint8x16_t bytes = vreinterpretq_u8_u16(vaddq_u16(vmulq_n_u16(a, 0x0202), vdupq_n_u16(0x0100)));
    const uint8x16_t eight = vreinterpretq_u8_u16(vld1q_u16(table));
#if defined(__aarch64__)
    return vreinterpretq_u16_u8(vqtbl1q_u8(eight, bytes));
#else
    const uint8x8x2_t halves = {{vget_low_u8(eight), vget_high_u8(eight)}};
    return vreinterpretq_u16_u8(
        vcombine_u8(vtbl2_u8(halves, vget_low_u8(bytes)), vtbl2_u8(halves, vget_high_u8(bytes))));
#endif
  }
};

}  // namespace pliant

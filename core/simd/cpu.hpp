// What this CPU can do, and the bodies of kernels that follow from a setting.
#pragma once

#include <cstdint>

#include "core/track_settings.hpp"

namespace pliant {

/// Families of SIMD bodies. A kernel may have finer ones (CpuFeatures) that give the same bits.
enum class SimdBody : std::uint8_t { scalar, sse41, avx2, neon };

/// Asked from the CPU at each call: ask at start-up, not in a frame.
struct CpuFeatures {
  bool sse41 = false;
  bool avx2 = false;
  bool avx512vnni = false;  ///< with the byte and word instructions and the shorter vectors
  bool neon = false;
  bool dot_products = false;  ///< of 8-bit lanes (ARMv8.2)
};
[[nodiscard]] CpuFeatures cpu_features() noexcept;

/// The best body for `automatic`, the named one where the CPU has it, else the scalar one.
[[nodiscard]] SimdBody simd_body(Kernels kernels) noexcept;

}  // namespace pliant

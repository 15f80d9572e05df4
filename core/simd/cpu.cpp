#include "core/simd/cpu.hpp"

#if defined(__aarch64__) || defined(__arm__)
#include <sys/auxv.h>
#endif

namespace pliant {

CpuFeatures cpu_features() noexcept {
  CpuFeatures has;
#if defined(__x86_64__) || defined(__i386__)
  __builtin_cpu_init();
  has.sse41 = __builtin_cpu_supports("sse4.1") != 0;
  has.avx2 = __builtin_cpu_supports("avx2") != 0;
  has.avx512vnni = __builtin_cpu_supports("avx512vnni") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
                   __builtin_cpu_supports("avx512vl") != 0;
#elif defined(__aarch64__)
  constexpr unsigned long kDotProducts = 1UL << 20;  // HWCAP_ASIMDDP
  has.neon = true;
  has.dot_products = (getauxval(AT_HWCAP) & kDotProducts) != 0;
#elif defined(__arm__)
  constexpr unsigned long kNeon = 1UL << 12;  // HWCAP_NEON
  has.neon = (getauxval(AT_HWCAP) & kNeon) != 0;
#endif
  return has;
}

SimdBody simd_body(Kernels kernels) noexcept {
  const CpuFeatures has = cpu_features();
  const bool automatic = kernels == Kernels::automatic;
  if (has.avx2 && (automatic || kernels == Kernels::avx2)) return SimdBody::avx2;
  if (has.sse41 && (automatic || kernels == Kernels::sse)) return SimdBody::sse41;
  if (has.neon && (automatic || kernels == Kernels::neon)) return SimdBody::neon;
  return SimdBody::scalar;
}

}  // namespace pliant

#include "core/fixed/moment_rows.hpp"

namespace pliant {

void add_moment_rows_scalar(const MomentRow* rows, std::size_t count, PlaneMoments& moments) noexcept {
  for (std::size_t k = 0; k < count; ++k) moments.add(rows[k].j, rows[k].residual, rows[k].weight);
}

AddMomentRows add_moment_rows(SimdBody body) noexcept {
#if defined(__x86_64__) || defined(__i386__)
  if (body == SimdBody::avx2) return add_moment_rows_avx2;
#elif defined(__aarch64__) || defined(__arm__)
  if (body == SimdBody::neon) return add_moment_rows_neon;
#else
  static_cast<void>(body);
#endif
  return add_moment_rows_scalar;
}

}  // namespace pliant

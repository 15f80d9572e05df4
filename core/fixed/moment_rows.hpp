// Many rows of a point-to-plane problem at once: the kernel that most of a frame's sums are taken with.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/fixed/moments.hpp"
#include "core/simd/cpu.hpp"

namespace pliant {

/// What PlaneMoments::add() takes; its formats and bounds.
struct MomentRow {
  std::array<std::int32_t, 6> j;
  std::int32_t residual = 0, weight = 0;
};
static_assert(sizeof(MomentRow) == 32);

/// Adds all rows. Exact: bodies give the same bits as PlaneMoments::add() row by row. A row's products of
/// weight and arm or residual stay below 2^26, so that all products are of 32 bits with 64-bit results.
using AddMomentRows = void (*)(const MomentRow* rows, std::size_t count, PlaneMoments& moments) noexcept;

void add_moment_rows_scalar(const MomentRow* rows, std::size_t count, PlaneMoments& moments) noexcept;
void add_moment_rows_avx2(const MomentRow* rows, std::size_t count, PlaneMoments& moments) noexcept;
void add_moment_rows_neon(const MomentRow* rows, std::size_t count, PlaneMoments& moments) noexcept;

/// Two lanes of 64 bits gain nothing over the scalar body: SSE has none of its own.
[[nodiscard]] AddMomentRows add_moment_rows(SimdBody body) noexcept;

/// Rows on their way into moments.
class MomentRowBuffer {
 public:
  static constexpr std::size_t kMost = 64;

  MomentRowBuffer(AddMomentRows body, PlaneMoments& moments) noexcept : body_(body), moments_(moments) {}
  MomentRowBuffer(const MomentRowBuffer&) = delete;
  MomentRowBuffer& operator=(const MomentRowBuffer&) = delete;
  ~MomentRowBuffer() = default;

  void add(const MomentRow& row) noexcept {
    rows_[count_++] = row;
    if (count_ == kMost) flush();
  }

  /// To be called after the last row.
  void flush() noexcept {
    if (count_ > 0) body_(rows_.data(), count_, moments_);
    count_ = 0;
  }

 private:
  AddMomentRows body_;
  PlaneMoments& moments_;
  std::size_t count_ = 0;
  std::array<MomentRow, kMost> rows_;
};

}  // namespace pliant

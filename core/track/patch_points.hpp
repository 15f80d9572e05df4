// The model's points ordered for kernels that work patch by patch.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "core/limits.hpp"
#include "core/memory/workspace.hpp"

namespace pliant {

struct ModelTables;

/// The model's points once more, patch by patch, so that what shares a pose and a piece of the picture stands
/// together. Patches begin at multiples of kBlock; what fills them up is zero.
struct PatchPoints {
  static constexpr std::size_t kBlock = 8;

  std::array<std::uint16_t, limits::kMaxPatches> begin{};  ///< of each patch in the arrays below
  std::array<std::uint16_t, limits::kMaxPatches> count{};
  std::span<std::uint16_t> index;  ///< in the model, ascending within a patch
  std::span<std::int16_t> x, y, z, nx, ny, nz;

  /// So many points with what fills up their last block.
  [[nodiscard]] static constexpr std::size_t filled_up(std::size_t points) noexcept {
    return (points + kBlock - 1) / kBlock * kBlock;
  }
  /// Where, in [from, to) of one patch, the first `size` points of the model end.
  [[nodiscard]] std::size_t below(std::size_t size, std::size_t from, std::size_t to) const noexcept {
    const std::span<const std::uint16_t> own = index.subspan(from, to - from);
    return from + static_cast<std::size_t>(std::lower_bound(own.begin(), own.end(), size) - own.begin());
  }
  void lay_out(Workspace& workspace, std::size_t points) noexcept;
  /// From the tables that the model itself fills.
  void start(const ModelTables& model) noexcept;
};

}  // namespace pliant

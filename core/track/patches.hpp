// The model's surface in patches: what is decided about motion is decided for patches, not for single points.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "core/limits.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

using limits::kMaxBodyLinks;
using limits::kMaxBorders;
using limits::kMaxPatches;

/// A set of patches, one bit each.
class PatchSet {
 public:
  [[nodiscard]] bool has(std::size_t p) const noexcept { return (words_[p >> 5] >> (p & 31) & 1U) != 0; }
  void add(std::size_t p) noexcept { words_[p >> 5] |= 1U << (p & 31); }
  [[nodiscard]] bool operator==(const PatchSet&) const noexcept = default;
  /// Calls `visit(p)` for every patch of the set, ascending.
  template <typename Visit>
  void for_each(Visit visit) const noexcept {
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint32_t rest = words_[w]; rest != 0; rest &= rest - 1)
        visit(32 * w + static_cast<std::size_t>(std::countr_zero(rest)));
  }

 private:
  std::array<std::uint32_t, (kMaxPatches + 31) / 32> words_{};
};

/// Where two patches meet.
struct PatchBorder {
  std::uint8_t a = 0, b = 0;
  std::uint32_t edges = 0;           ///< of the surface graph that cross it
  Vector3 centre = Vector3::Zero();  ///< model frame, metres
  double length = 0;                 ///< from one patch's centre to the other's, metres
};

/// What lies between two patches on opposite sides of the body.
struct PatchTie {
  std::uint8_t a = 0, b = 0;
  std::uint32_t looks = 0;           ///< from either patch that met the other
  Vector3 middle = Vector3::Zero();  ///< between its ends, model frame, metres
  double length = 0;                 ///< from one end to the other, metres
};

/// The model's spring network as the frame path works on it.
struct PatchTables {
  std::size_t count = 0;
  double radius = 0;                               ///< of a patch, metres
  std::span<const std::uint8_t> patch_of;          ///< by model point
  std::span<const PointBlend> blend;               ///< by model point
  std::array<PatchSet, kMaxPatches> neighbours{};  ///< that share a border
  std::array<std::uint32_t, kMaxPatches> sizes{};  ///< points
  std::array<Vector3, kMaxPatches> centres;        ///< model frame, metres
  std::array<PatchBorder, kMaxBorders> borders;    ///< ascending by (a, b)
  std::size_t border_count = 0;              ///< at most kMaxBorders; further ones hold nothing together
  std::array<PatchTie, kMaxBodyLinks> ties;  ///< ascending by (a, b)
  std::size_t tie_count = 0;

  /// Looks into `model`, which must outlive it.
  void start(const ModelView& model) noexcept;
};

}  // namespace pliant

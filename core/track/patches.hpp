// The model's surface in patches: what is decided about motion is decided for patches, not for single points.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/limits.hpp"
#include "core/memory/workspace.hpp"
#include "core/track/model_tables.hpp"

namespace pliant {

using limits::kMaxBorders;
using limits::kMaxPatches;

/// A set of patches, one bit each.
class PatchSet {
 public:
  [[nodiscard]] bool has(std::size_t p) const noexcept { return (words_[p >> 5] >> (p & 31) & 1U) != 0; }
  void add(std::size_t p) noexcept { words_[p >> 5] |= 1U << (p & 31); }
  [[nodiscard]] bool operator==(const PatchSet&) const noexcept = default;

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

/// The patches that a point moves with when the surface bends.
struct PointBlend {
  static constexpr int kShift = 7;
  std::array<std::uint8_t, 4> patch{};
  std::array<std::uint8_t, 4> weight{};  ///< Q7, sum 128
};

/// Every point belongs to the patch of the seed that is nearest along the surface graph; the seeds are the
/// first points of the model, a uniform sampling.
struct PatchTables {
  std::size_t count = 0;
  double radius = 0;                               ///< of a patch, metres
  std::span<std::uint8_t> patch_of;                ///< by model point
  std::span<PointBlend> blend;                     ///< by model point
  std::array<PatchSet, kMaxPatches> neighbours{};  ///< that share an edge of the graph
  std::array<std::uint32_t, kMaxPatches> sizes{};  ///< points
  std::array<Vector3, kMaxPatches> centres;        ///< model frame, metres
  std::array<PatchBorder, kMaxBorders> borders;    ///< ascending by (a, b)
  std::size_t border_count = 0;  ///< at most kMaxBorders; further ones hold nothing together

  void lay_out(Workspace& workspace, std::size_t points) noexcept;
  /// `queue`: scratch of the model's size.
  void start(const ModelTables& model, std::span<std::uint16_t> queue) noexcept;
};

}  // namespace pliant

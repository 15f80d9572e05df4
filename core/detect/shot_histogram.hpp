// The histogram of a SHOT descriptor: in which bins each point of a support counts, and by how much.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// Points of a support in the local frame. Lengths in units of the support's radius.
struct ShotPoints {
  std::span<const float> x, y, z, distance;
  std::span<const float> nx, ny, nz;  ///< unit normals
  std::size_t count = 0;
  float axes[9] = {};  ///< rows are the local axes
};

/// Every point is spread over two neighbouring bins of azimuth, elevation, radius and cosine, linearly. All
/// quantities of a point are found lane by lane, the bins are filled point after point: every vector width
/// gives the same bits.
class ShotBins {
 public:
  static constexpr std::size_t kLanes = 8;  ///< arrays are padded to whole groups of so many

  void lay_out(Workspace& workspace, std::size_t most_points) noexcept;
  /// False when no point counts; the descriptor is zero then. Spans of `points` hold whole groups of lanes.
  [[nodiscard]] bool fill(const ShotPoints& points, Descriptor& descriptor) noexcept;

 private:
  void place(const ShotPoints& points) noexcept;

  std::span<std::int32_t> azimuth_bin_, cosine_bin_;
  std::span<float> azimuth_part_, cosine_part_, up_, outer_, weight_;
};

}  // namespace pliant

// Which readings are the object's, decided for cells of 2×2 pixels.
#pragma once

#include <cstdint>
#include <span>

#include "core/capture/background.hpp"
#include "core/capture/distance_volume.hpp"
#include "core/capture/view_picture.hpp"
#include "core/memory/workspace.hpp"
#include "core/track/model_tables.hpp"

namespace pliant {

/// What a cell shows.
enum class Cell : std::uint8_t {
  nothing,  ///< no reading, background, too far away
  known,    ///< the object as it was fused so far
  fresh,    ///< something where nothing was known
  against,  ///< something where the camera saw through before: it moves against the object
  outside   ///< something beside the volume
};

/// The thing to be captured, as found in one picture.
struct Target {
  std::uint32_t cells = 0;   ///< 0: nothing there
  IntPoint lowest, highest;  ///< bounding box in the camera's frame, 1/16 mm
  IntPoint middle;           ///< of its readings, 1/16 mm
  int u = 0, v = 0;          ///< its middle in the picture, pixels
};

class ObjectCells {
 public:
  void lay_out(Workspace& workspace, const Intrinsics& camera) noexcept;
  void start(double clearance) noexcept {
    clearance_ = static_cast<std::int32_t>(clearance * kUnitsPerMetre);
  }

  /// Finds what stands before the background in a new picture; the others build on it.
  void look(const Surface& surface, const BackgroundPlanes& background) noexcept;

  /// Finds the connected thing before the background that is nearest to pixel (u, v), with the larger of two
  /// that are equally near, and takes its cells. Things that reach over more than `size` metres are not
  /// considered unless pixel (u, v) was chosen by the user.
  [[nodiscard]] Target find_target(const Surface& surface, const BackgroundPlanes& background, int u, int v,
                                   bool chosen, double size) noexcept;

  /// Tells the object from what is beside it by what the volume knows: cells in space that was seen to be
  /// free are against it, and so is new surface that hangs together with more than a quarter of such cells,
  /// or with nothing that is known. `gate`: farthest from the known surface, 1/16 mm.
  void judge(const Surface& surface, const DistanceVolume& volume, const FixedPose& model_from_camera,
             std::int32_t gate) noexcept;

  [[nodiscard]] CellMask mask() const noexcept { return {taken_, width_}; }
  [[nodiscard]] std::uint32_t count(Cell kind) const noexcept {
    return counts_[static_cast<std::size_t>(kind)];
  }
  /// How many cells are taken.
  [[nodiscard]] std::size_t taken() const noexcept;
  /// The window of the taken cells, pixels.
  [[nodiscard]] Window window() const noexcept;
  /// Taken cells' readings with their normals, evenly thinned out to at most out.size().
  [[nodiscard]] std::size_t sample(const Surface& surface, std::int32_t normal_span,
                                   std::span<ViewPoint> out) const noexcept;
  /// Takes every cell before the background whose reading lies near what was fused: what alignment looks at.
  void take_near(const Surface& surface, const DistanceVolume& volume,
                 const FixedPose& model_from_camera) noexcept;

 private:
  [[nodiscard]] bool reading(const Surface& surface, const BackgroundPlanes& background, int cell,
                             IntPoint& p) const noexcept;
  [[nodiscard]] IntPoint vertex(const Surface& surface, int cell) const noexcept {
    const int u = cell % width_ * 2, v = cell / width_ * 2;
    return surface.vertex(u, v, surface.depth_at(u, v));
  }
  /// Takes what hovers within 3 cm of the target: sensors lose dark or steep pieces between two parts of one
  /// object, and nothing hovers by itself.
  void take_hovering(const Surface& surface, const BackgroundPlanes& background, Target& target) noexcept;
  /// Collects in queue_ the cells that hang together with `seed` and are of a kind in `kinds` (a bit each).
  std::size_t flood(const Surface& surface, int seed, unsigned kinds, std::uint8_t mark) noexcept;
  void forbid_with(const Surface& surface, unsigned kinds, std::uint8_t mark,
                   bool (*forbidden)(const std::uint32_t (&)[5])) noexcept;

  int width_ = 0, height_ = 0;  // cells
  std::int32_t clearance_ = 0;
  std::span<Cell> kind_;
  std::span<std::uint8_t> taken_, marked_;
  std::span<std::uint8_t> stands_out_;  // of this picture
  std::span<std::int32_t> queue_;
  std::uint32_t counts_[5] = {0, 0, 0, 0, 0};
};

}  // namespace pliant

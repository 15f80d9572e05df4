// SHOT: signatures of histograms of orientations (Salti, Tombari, Di Stefano: SHOT: Unique Signatures of
// Histograms for Surface and Texture Description, CVIU 2014), the descriptor of the paper's section 3.1, with
// its repeatable local reference frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/point_grid.hpp"
#include "core/detect/shot_histogram.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// A cloud with unit normals (Q14), metres. The normals of a model point outward, those of a scene towards
/// the camera: both away from the matter, so that descriptors of model and scene agree in sign.
struct OrientedPoints {
  std::span<const Point3f> positions;
  std::span<const Normal16> normals;
};

/// The radius of the descriptors of a model, metres: wide enough to hold the points that a stable frame
/// takes, a fixed share of the object so that it says where on the object it is.
[[nodiscard]] double support_radius_for(double spacing, double model_radius) noexcept;

/// The cell edge with which a PointGrid answers descriptor queries of this radius fastest.
[[nodiscard]] inline double grid_cell_for_support(double support_radius) noexcept {
  return 0.5 * support_radius;
}

/// Computes descriptors one at a time. Work a descriptor is bounded by kMostNeighbours.
class ShotDescriber {
 public:
  static constexpr std::size_t kMostNeighbours = 4096;  ///< further ones in the support are not looked at
  static constexpr std::size_t kLeastNeighbours = 12;   ///< fewer points tell nothing

  /// Takes the scratch memory (about 230 kB).
  void lay_out(Workspace& workspace) noexcept;

  /// Descriptor and frame at `points.positions[index]` from the points within `support_radius` (metres),
  /// found through `grid`, which indexes `points.positions`. False when there are too few or their spread
  /// fixes no frame (a plane, one point repeated); the outputs are zero then. `lean`: how far the normals
  /// lean to the x axis on average, the sine of an angle: the frame of a flat or round support, whose lean is
  /// small, means little.
  [[nodiscard]] bool describe(const OrientedPoints& points, const PointGrid& grid, std::size_t index,
                              double support_radius, Descriptor& descriptor, LocalFrame& frame,
                              float* lean = nullptr) noexcept {
    return describe_at(points, grid, points.positions[index], support_radius, descriptor, frame, lean);
  }
  /// As describe(), at any place on or near the surface.
  [[nodiscard]] bool describe_at(const OrientedPoints& points, const PointGrid& grid, const Point3f& centre,
                                 double support_radius, Descriptor& descriptor, LocalFrame& frame,
                                 float* lean = nullptr) noexcept;

 private:
  /// The points in the support, one array a quantity, padded so that whole groups of lanes may be read.
  struct Support {
    std::span<float> x, y, z;     // from the keypoint, in units of the support radius
    std::span<float> distance;    // the same unit; 1 in the padding
    std::span<float> nx, ny, nz;  // normals, unit length; 0 in the padding
    std::span<std::uint32_t> index;
    std::size_t count = 0;
  };
  [[nodiscard]] bool find_frame(LocalFrame& frame, float (&axes)[9], float* lean) const noexcept;

  Support support_;
  ShotBins bins_;
};

}  // namespace pliant

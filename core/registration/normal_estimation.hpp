// Normals of a cloud: the paper's first stage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/point_grid.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// Unsigned normals of `at` from the principal components of the points within `radius` (metres) in `grid`;
/// where these are fewer than eight, within twice and four times the radius. Zero where even that is too
/// little. A neighbourhood's first kMostNeighbours points count.
void estimate_normals(const PointGrid& grid, std::span<const Point3f> at, double radius,
                      std::span<Normal16> normals) noexcept;

/// Turns normals so that they agree between model and scene: away from the matter.
class NormalOrientation {
 public:
  static constexpr std::size_t kEdges = 6;  ///< looked at for each point

  void lay_out(Workspace& workspace, std::size_t capacity) noexcept;

  /// Towards `viewpoint`.
  static void towards(std::span<const Point3f> points, const Point3f& viewpoint,
                      std::span<Normal16> normals) noexcept;
  /// Without a viewpoint (Hoppe et al.: Surface reconstruction from unorganized points, SIGGRAPH 1992): signs
  /// spread over the neighbour graph, edges of the most alike normals first, none across creases of more than
  /// 60°; each connected piece then turns outward, as its own shape tells (the flux of its normals from its
  /// centre), and where it does not (a table), towards the side on which the rest of the scene stands. `grid`
  /// indexes `points`, neighbours stand within `reach` metres.
  void outward(std::span<const Point3f> points, const PointGrid& grid, double reach,
               std::span<Normal16> normals) noexcept;

 private:
  struct Edge {
    std::uint32_t a, b;
  };
  /// A connected piece of the scene.
  struct Piece {
    Point3f centre;
    float size = 0;   // points
    float flux = 0;   // sum of n · (p − centre)
    float reach = 0;  // sum of |p − centre|
    float lean = 0;   // sum of n · (middle of the scene − p)
  };
  std::uint32_t root(std::uint32_t i, bool& flipped) noexcept;

  std::span<Edge> edges_, sorted_;
  std::span<std::uint8_t> keys_;
  std::span<std::uint32_t> parent_;  // of the union-find forest
  std::span<std::uint8_t> parity_;   // whether a point's sign is opposite to its parent's
  std::span<Piece> pieces_;          // at each piece's root
};

}  // namespace pliant

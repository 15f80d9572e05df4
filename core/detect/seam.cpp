#include "core/detect/seam.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/detect/fast_transform.hpp"

namespace pliant {

namespace {

constexpr int kSide = 32;           // cells
constexpr int kMiddle = kSide / 2;  // the cell of the axis
constexpr float kReach = 1.35F;     // half of the grid in model radii

constexpr float kLeastPixels = 4;  // a cell's edge: depth sensors smear edges over several pixels
constexpr float kAlike = 0.82F;    // cos 35°: what the noise of two fitted normals leaves of one direction

struct Cell {
  float depth = 0;  // of the nearest point in it, 0: empty
  Point3f point, normal;
};

using RowBits = std::array<std::uint32_t, kSide>;  // a bit a cell

/// The cells and their neighbours.
RowBits spread(const RowBits& cells) noexcept {
  RowBits out{};
  for (std::size_t row = 0; row < kSide; ++row) {
    const std::uint32_t near =
        cells[row] | (row > 0 ? cells[row - 1] : 0) | (row + 1 < kSide ? cells[row + 1] : 0);
    out[row] = near | near << 1 | near >> 1;
  }
  return out;
}

/// What the snapshot shows in the direction of `at`; false where there is no reading.
bool look(const DepthSnapshot& snapshot, const Point3f& at, Point3f& point, Point3f& normal) noexcept {
  int u = 0, v = 0;
  if (!snapshot.project(at, u, v) || snapshot.depth(u, v) == 0) return false;
  const Normal16& seen = snapshot.normal(u, v);
  normal = {static_cast<float>(seen.x) / 16384, static_cast<float>(seen.y) / 16384,
            static_cast<float>(seen.z) / 16384};
  point = snapshot.vertex(u, v);
  return true;
}

/// Both points lie on one smooth surface: alike normals, and the second on the first's tangent plane.
bool continues(const DepthSnapshot& snapshot, float tolerance, const Point3f& a, const Point3f& a_normal,
               const Point3f& b, const Point3f& b_normal) noexcept {
  if (dot(a_normal, b_normal) < kAlike) return false;
  const Point3f gap = {b.x - a.x, b.y - a.y, b.z - a.z};
  return std::fabs(dot(gap, a_normal)) <= tolerance + 2 * sigma_at(snapshot.sensor(), b.z);
}

}  // namespace

SeamEvidence seam_evidence(const ModelView& model, const DepthSnapshot& snapshot, const RigidTransform& pose,
                           std::size_t count, double tolerance) noexcept {
  SeamEvidence evidence;
  const FastTransform fast(pose);
  const Vector3 centre = pose * model.centre();
  const auto cx = static_cast<float>(centre.x()), cy = static_cast<float>(centre.y()),
             cz = static_cast<float>(centre.z());
  const auto radius = static_cast<float>(model.radius());
  if (!(cz > radius)) return evidence;
  // The grid stands on the plane through the centre, across the view.
  const float pixel = cz / static_cast<float>(snapshot.camera().fx);
  const float cell_edge = std::max(2 * kReach * radius / kSide, kLeastPixels * pixel);
  Cell grid[kSide][kSide];
  count = std::min(count, model.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Point3f p = fast.point(model.positions()[i]);
    if (p.z < 0.5F * cz) continue;
    const float scale = cz / p.z;
    const float across = (p.x * scale - cx) / cell_edge + kMiddle;
    const float down = (p.y * scale - cy) / cell_edge + kMiddle;
    if (!(across >= 0 && down >= 0 && across < kSide && down < kSide)) continue;
    Cell& cell = grid[static_cast<int>(down)][static_cast<int>(across)];
    if (cell.depth == 0 || p.z < cell.depth) {
      cell.depth = p.z;
      cell.point = p;
      cell.normal = fast.direction(model.normals()[i]);
    }
  }
  const auto base = static_cast<float>(tolerance);
  // From here on a cell holds what is seen at its point. Only what agrees with the picture has an outline
  // there.
  RowBits agreeing{};
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      Cell& cell = grid[row][column];
      if (cell.depth == 0) continue;
      Point3f point, normal;
      const bool agrees = look(snapshot, cell.point, point, normal) &&
                          continues(snapshot, base, cell.point, cell.normal, point, normal);
      cell = agrees ? Cell{cell.depth, point, normal} : Cell{};
      if (agrees) agreeing[static_cast<std::size_t>(row)] |= 1U << column;
    }
  // A ring cell: nothing that agrees in the 3×3 cells around it, something in the 5×5.
  const RowBits inner = spread(agreeing), outer = spread(inner);
  for (int row = 0; row < kSide; ++row)
    for (std::uint32_t ring = outer[static_cast<std::size_t>(row)] & ~inner[static_cast<std::size_t>(row)];
         ring != 0; ring &= ring - 1) {
      const int column = std::countr_zero(ring);
      const Cell* nearest = nullptr;
      int nearest_square = 100;
      for (int dr = -2; dr <= 2; ++dr)
        for (int dc = -2; dc <= 2; ++dc) {
          const int r = row + dr, c = column + dc;
          if (r < 0 || c < 0 || r >= kSide || c >= kSide || grid[r][c].depth == 0) continue;
          const int square = dr * dr + dc * dc;
          if (square < nearest_square) {
            nearest_square = square;
            nearest = &grid[r][c];
          }
        }
      if (nearest == nullptr) continue;
      const Point3f ray = {cx + (static_cast<float>(column - kMiddle) + 0.5F) * cell_edge,
                           cy + (static_cast<float>(row - kMiddle) + 0.5F) * cell_edge, cz};
      Point3f point, normal;
      if (!look(snapshot, ray, point, normal)) continue;
      ++evidence.ring;
      if (continues(snapshot, base, nearest->point, nearest->normal, point, normal)) ++evidence.seamless;
    }
  return evidence;
}

}  // namespace pliant

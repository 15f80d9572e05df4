// Labels of the model points under a chain of rigid transforms: the paper's inlier test (section 3.2) and its
// search for the deformed points (section 3.3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/point_grid.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/memory/workspace.hpp"
#include "core/model/model_view.hpp"
#include "core/track_result.hpp"

namespace pliant {

/// What the scene shows of the surface around one model point under one transform.
struct SurfaceGap {
  float along = 0;          ///< mean signed distance of the readings from the model's surface, metres
  float spread = 0;         ///< root mean square around that mean, metres
  std::uint32_t count = 0;  ///< of readings, 0: the scene shows nothing there
};

/// Every scene point is a reading of the model point that it lies nearest to: its distance from that point's
/// tangent plane. What a model point's surroundings say is the mean over itself and its neighbours in the
/// surface graph, so that curvature does not count as distance while noise averages out.
class SurfaceReadings {
 public:
  void lay_out(Workspace& workspace, std::size_t model_points) noexcept;
  /// Takes the readings of all `scene` points under `pose` (scene <- model); points with a non-zero entry in
  /// `taken` (may be empty) are passed over. Readings farther than `depth` off the plane or `across` beside
  /// the point (metres) are none. `index` holds the model's positions.
  void measure(const ModelView& model, const PointGrid& index, std::span<const Point3f> scene,
               std::span<const std::uint8_t> taken, const RigidTransform& pose, double across,
               double depth) noexcept;
  [[nodiscard]] SurfaceGap gap(const ModelView& model, std::size_t i) const noexcept;
  /// The nearest scene point that is a reading of point i, PointGrid::kNone for none.
  [[nodiscard]] std::uint32_t nearest(std::size_t i) const noexcept { return nearest_[i]; }
  [[nodiscard]] float distance(std::size_t i) const noexcept { return distance_[i]; }

 private:
  std::span<float> sum_, squares_, distance_;
  std::span<std::uint32_t> count_, nearest_;
};

/// Gives islands of a label (connected pieces of the model's surface graph) of fewer than `least` points to
/// the label that surrounds them; a piece that touches no other label stays. Two passes.
class IslandFilter {
 public:
  void lay_out(Workspace& workspace, std::size_t points) noexcept;
  /// `may_join(i, label)`: whether point i can bear the label of its surroundings.
  template <typename MayJoin>
  void filter(const ModelView& model, std::size_t least, std::span<std::int8_t> labels,
              MayJoin&& may_join) noexcept;
  /// The connected pieces of the points for which wanted(i): piece[i] = its number + 1, 0 for none. Returns
  /// the largest piece's number + 1 and its size through `size`.
  template <typename Wanted>
  std::uint32_t pieces(const ModelView& model, Wanted&& wanted, std::uint32_t& size) noexcept;
  [[nodiscard]] std::span<const std::uint32_t> piece() const noexcept { return piece_; }

 private:
  std::span<std::uint32_t> piece_;
  std::span<std::uint16_t> queue_;
};

template <typename Wanted>
std::uint32_t IslandFilter::pieces(const ModelView& model, Wanted&& wanted, std::uint32_t& size) noexcept {
  for (std::uint32_t& p : piece_) p = 0;
  std::uint32_t count = 0, largest = 0;
  size = 0;
  for (std::size_t seed = 0; seed < model.size(); ++seed) {
    if (piece_[seed] != 0 || !wanted(seed)) continue;
    ++count;
    std::size_t head = 0, tail = 0;
    queue_[tail++] = static_cast<std::uint16_t>(seed);
    piece_[seed] = count;
    while (head < tail) {
      const std::size_t i = queue_[head++];
      for (const std::uint16_t j : model.neighbours(i)) {
        if (j == kNoNeighbour || piece_[j] != 0 || !wanted(j)) continue;
        piece_[j] = count;
        queue_[tail++] = j;
      }
    }
    if (tail > size) {
      size = static_cast<std::uint32_t>(tail);
      largest = count;
    }
  }
  return largest;
}

template <typename MayJoin>
void IslandFilter::filter(const ModelView& model, std::size_t least, std::span<std::int8_t> labels,
                          MayJoin&& may_join) noexcept {
  for (std::uint32_t& p : piece_) p = 0;
  std::uint32_t count = 0;
  for (std::size_t seed = 0; seed < model.size(); ++seed) {
    if (piece_[seed] != 0) continue;
    ++count;
    const std::int8_t label = labels[seed];
    std::size_t head = 0, tail = 0;
    // What surrounds the piece: votes for each label, kNotObserved (-2) at 0.
    std::uint32_t votes[limits::kMaxRegions + 2] = {};
    queue_[tail++] = static_cast<std::uint16_t>(seed);
    piece_[seed] = count;
    while (head < tail) {
      const std::size_t i = queue_[head++];
      for (const std::uint16_t j : model.neighbours(i)) {
        if (j == kNoNeighbour) continue;
        if (labels[j] != label) {
          ++votes[static_cast<std::size_t>(labels[j] + 2)];
          continue;
        }
        if (piece_[j] != 0) continue;
        piece_[j] = count;
        queue_[tail++] = j;
      }
    }
    if (tail >= least) continue;
    std::size_t best = 0;
    for (std::size_t v = 1; v < limits::kMaxRegions + 2; ++v)
      if (votes[v] > votes[best]) best = v;
    if (votes[best] == 0) continue;
    const auto surroundings = static_cast<std::int8_t>(static_cast<int>(best) - 2);
    for (std::size_t k = 0; k < tail; ++k)
      if (may_join(queue_[k], surroundings)) labels[queue_[k]] = surroundings;
  }
}

}  // namespace pliant

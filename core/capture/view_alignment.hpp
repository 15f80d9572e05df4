// Aligns a view to what was fused so far, and two views to each other.
#pragma once

#include <cstdint>
#include <span>

#include "core/capture/distance_volume.hpp"
#include "core/capture/plane_rows.hpp"
#include "core/capture/view_picture.hpp"
#include "core/geometry/vector6.hpp"
#include "core/track/model_tables.hpp"

namespace pliant {

/// How a view lies on the volume.
struct ViewFit {
  RigidTransform pose;         ///< camera <- model
  std::uint32_t agreeing = 0;  ///< points on the known surface, within the weights' reach
  std::uint32_t against = 0;   ///< points in free space, or beside the known surface
  std::uint32_t fresh = 0;     ///< points where nothing was known
  double rms = 0;              ///< of the agreeing ones, metres
  /// Of all small motions of the view, the least share of a motion that the surface shows (compare
  /// drivers' characterisability): next to nothing for a ball or a plate.
  double held = 0;
  double radius = 0;  ///< of the known surface that is seen, root mean square, metres

  /// Of the points that can be judged, the share that agrees.
  [[nodiscard]] double agreement() const noexcept {
    const std::uint32_t judged = agreeing + against;
    return judged > 0 ? static_cast<double>(agreeing) / judged : 0;
  }
};

struct ViewAlignSettings {
  int iterations = 10;  ///< at most
  double prior_rotation =
      0.03;  ///< how far the view turns off its prediction, one standard deviation, radians
  double prior_translation = 0.006;  ///< and moves, metres
  std::int32_t noise = 24;           ///< σ of the readings, 1/16 mm
  bool stands = false;               ///< mostly in the pixels it was fused from, which err as they did then
};

/// Distance-to-surface alignment (Canelhas, Stoyanov, Lilienthal: SDF Tracker, IROS 2013; Bylow et al.:
/// Real-time camera tracking and 3D reconstruction using signed distance functions, RSS 2013): every point
/// reads its distance and the surface's direction from the volume; no surface is drawn. `rows`: kViewPoints
/// of scratch.
[[nodiscard]] ViewFit align_to_volume(std::span<const ViewPoint> points, const DistanceVolume& volume,
                                      const RigidTransform& predicted, const ViewAlignSettings& settings,
                                      std::span<PlaneRow> rows) noexcept;

/// A view to align others to.
struct PosedPicture {
  ViewPicture picture;
  RigidTransform pose;  ///< camera <- model
};
/// Rows that take `points` of a view at `pose` to the readings of `other` at their pixels (projective
/// point-to-plane): points that both see, from within 60° of their normal, not farther apart than `gate`
/// (1/16 mm, at most 8191) along the line of sight. Returns how many of `rows` were written.
[[nodiscard]] std::size_t pair_rows(std::span<const ViewPoint> points, const RigidTransform& pose,
                                    const PosedPicture& other, const Projector& projector,
                                    const Surface& rays, std::int32_t gate,
                                    std::span<PlaneRow> rows) noexcept;

/// Brings a view near `picture` by pair_rows() with a gate that narrows from `gate` (metres): reaches farther
/// than the volume, whose distances end. False when too few points find a partner.
[[nodiscard]] bool align_to_picture(std::span<const ViewPoint> points, const PosedPicture& other,
                                    const Projector& projector, const Surface& rays, double gate,
                                    const ViewAlignSettings& settings, std::span<PlaneRow> rows,
                                    RigidTransform& pose) noexcept;

}  // namespace pliant

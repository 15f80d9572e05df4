// One look at one model point under one pose.
#pragma once

#include "core/track/associate.hpp"
#include "core/track/contour.hpp"
#include "core/track/track_state.hpp"

namespace pliant {

/// Sees single points in the current surface.
class Sighting {
 public:
  struct Look {
    Sight sight = Sight::none;
    bool facing = false;      ///< faces the camera inside the picture
    std::int32_t match = -1;  ///< pixel
    std::int32_t residual =
        0;           ///< along the normal, 1/16 mm; positive: the reading lies outside, before the point
    IntPoint point;  ///< under the pose
    IntPoint normal;
  };

  Sighting(const ModelTables& model, const Surface& surface, const Projector& projector,
           const Tolerance& tolerance) noexcept
      : model_(model),
        surface_(surface),
        projector_(projector),
        tolerance_(tolerance),
        spacing_(surface.pixel_span(model.spacing / kUnitsPerMetre)) {}

  /// Looks at the reading of the point's pixel, then at the eight around it: the agreeing one with the
  /// smallest residual counts; without one, the central reading tells whether the point stands before or
  /// behind the surface.
  [[nodiscard]] Look look(std::size_t i, const FixedPose& pose) const noexcept {
    return look(pose.point(model_.x[i], model_.y[i], model_.z[i]),
                pose.direction(model_.nx[i], model_.ny[i], model_.nz[i]));
  }
  /// The same for a point and its outward normal (Q14).
  [[nodiscard]] Look look(const IntPoint& point, const IntPoint& normal) const noexcept;

  /// For a look at a point that faces the camera and has no reading, as beside an outline: the nearest
  /// reading within `reach` (1/16 mm, kFarthestReading at most) beside it that faces as the point does
  /// becomes its match; `normal` and `residual` tell which way and how far it lies. False, and nothing
  /// changes, where there is none.
  [[nodiscard]] bool look_beside(std::int32_t reach, Look& look) const noexcept;

  /// Does the camera see through the point under `pose`, whichever way it faces? Then it cannot be there.
  [[nodiscard]] bool refuted(std::size_t i, const FixedPose& pose) const noexcept {
    const IntPoint p = pose.point(model_.x[i], model_.y[i], model_.z[i]);
    int u = 0, v = 0;
    if (!projector_.project(p, u, v)) return false;
    const std::uint16_t z8 = surface_.depth(u, v);
    return z8 != 0 && 2 * z8 - p.z > 2 * tolerance_.deformed(p.z);
  }
  /// How far the outline lies from the point under `pose`, 1/16 mm, at most `reach`; false where the point
  /// does not lie on the outline, or none is seen.
  [[nodiscard]] bool from_contour(std::size_t i, const FixedPose& pose, std::int32_t reach,
                                  std::int32_t& distance) const noexcept {
    const IntPoint point = pose.point(model_.x[i], model_.y[i], model_.z[i]),
                   normal = pose.direction(model_.nx[i], model_.ny[i], model_.nz[i]);
    return on_rim(point, normal) &&
           find_contour(surface_, projector_, {reach, reach}, point, normal, distance);
  }
  /// What a pixel spans at depth z, both 1/16 mm.
  [[nodiscard]] std::int32_t pixel(std::int32_t z) const noexcept {
    return static_cast<std::int32_t>(projector_.length(256, z));
  }
  [[nodiscard]] const Tolerance& tolerance() const noexcept { return tolerance_; }

 private:
  /// A reading, by its pixel and depth, near the point.
  bool agrees_with(int u, int v, std::uint16_t z8, std::int32_t limit, const IntPoint& point,
                   const IntPoint& normal, std::int32_t& residual) const noexcept;

  const ModelTables& model_;
  const Surface& surface_;
  const Projector& projector_;
  const Tolerance& tolerance_;
  PixelSpan spacing_;
};

}  // namespace pliant

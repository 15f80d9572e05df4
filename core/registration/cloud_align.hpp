// Surface refinement of a pose on a cloud, and how much of the model the cloud shows under a pose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/detect/point_grid.hpp"
#include "core/detect/shot.hpp"
#include "core/geometry/rigid_transform.hpp"
#include "core/model/model_view.hpp"

namespace pliant {

/// A scene cloud and its index. `normals` may be empty; `taken` may be empty, else points with a non-zero
/// entry are passed over.
struct CloudTarget {
  const PointGrid* grid = nullptr;
  std::span<const Point3f> points;
  std::span<const Normal16> normals;
  std::span<const std::uint8_t> taken;
};

struct AlignSettings {
  double first_gate = 0.01;  ///< residuals beyond it are ignored at first, metres
  double last_gate = 0.005;  ///< and at last, metres
  double reach = 0.01;       ///< how far the nearest scene point may be, beside the gate's residual, metres
  int iterations = 10;
};

/// Robust point-to-plane alignment (Tukey's weights) of the model points `which` from `pose`. Planes are the
/// model's, which are free of noise; with target normals, pairs that differ by more than 45° are left out.
/// Returns how many pairs held in the last iteration, 0 when too few did.
[[nodiscard]] std::size_t align_to_cloud(const ModelView& model, std::span<const std::uint16_t> which,
                                         const CloudTarget& target, const AlignSettings& settings,
                                         RigidTransform& pose) noexcept;

/// Sum over the model points `which` of how closely the target (with normals) agrees, [0, 1] each: falls with
/// the square of the distance to none at `tolerance` (along the normal), and with the angle between the
/// normals from 25° to none at 60°. `reach`: how far the nearest scene point may be, metres.
[[nodiscard]] double cloud_agreement(const ModelView& model, std::span<const std::uint16_t> which,
                                     const CloudTarget& target, const RigidTransform& pose, double tolerance,
                                     double reach) noexcept;

}  // namespace pliant

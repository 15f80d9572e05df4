// How far the surface is stretched and bent: what the springs of the warp hold against.
#pragma once

#include "core/deform/patch_warp.hpp"

namespace pliant {

/// The strain up to which a material stretches: at the soft end like fleece, at the stiff end like leather.
/// `material` as in TrackSettings.
[[nodiscard]] constexpr double strain_limit(double material) noexcept {
  return 0.03 + 0.12 * material;
}
/// The angle, radians, by which two neighbouring patches bend as easily as they stretch to the limit.
[[nodiscard]] constexpr double bend_limit(double material) noexcept {
  return 0.1 + 0.4 * material;
}

struct Strain {
  double energy = 0;  ///< mean over the surface of (strain / limit)² + (bend / limit)²: 1 where all of it
                      ///< is stretched to the material's limit; joints between regions turn freely
  double overstrained = 0;                 ///< share of the surface that is stretched beyond the limit [0, 1]
  std::array<float, kMaxPatches> patch{};  ///< of each patch: root mean square of the relative change of its
                                           ///< centre's distances to its neighbours' centres
};

/// Of the warp as it is.
[[nodiscard]] Strain measure_strain(const PatchTables& patches, const PatchWarp& warp,
                                    double material) noexcept;

/// Of the surface around point i: the blend of its patches' strains; 0 where nothing stretches.
[[nodiscard]] float strain_at(const PatchTables& patches, const Strain& strain, std::size_t i) noexcept;

}  // namespace pliant

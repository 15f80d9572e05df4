// Motions of a view that its surface hardly shows.
#pragma once

#include <span>

#include "core/capture/plane_rows.hpp"
#include "core/track/plane_equations.hpp"

namespace pliant {

/// Of the rows' equations (of `robust`, about its centre) the part along motions that move the surface little
/// along its normal is taken anew, from the rows that tell of them.
///
/// A bottle that is turned moves only its lugs. The rest, seen in the same pixels as before, has the same
/// errors of the sensor as before, and these hold it where it was, with a hundred times as many rows. They
/// lean against the motion by some degrees only; so rows weigh by the fourth power of how much they lean, up
/// to 25° (geometric stability: Gelfand et al.: Geometrically stable sampling for the ICP algorithm, 3DIM
/// 2003). While the object `stands` in the pixels it was fused from, a row leans only as much as both the
/// known surface and the view's own normal do, and not at all when they lean to opposite sides: what flickers
/// is no lug.
struct WeakMotions {
  PlaneEquations equations;
  /// Of all small motions, the least share of a motion that telling rows see along their normals, the known
  /// surface's and the view's alike: errors of the two that are independent cancel. The motion moves points
  /// by about one, a turn about the centre by one at `radius` metres from it.
  double held = 0;
};
[[nodiscard]] WeakMotions weigh_weak_motions(std::span<const PlaneRow> rows, const RobustMoments& robust,
                                             double radius, bool stands) noexcept;

/// What the readings of a view are worth against a slip.
struct SlipNoise {
  double sigma = 0;     ///< of a reading, metres
  double alike = 1;     ///< rows that say as much as one, since neighbouring pixels err alike
  double standing = 1;  ///< Standstill::share()
};
/// The least `held` at which a slip by a tenth of the object's radius is noticed among `rows` rows: where
/// pixels err as they did when the surface was fused, it must move the surface along its normal by half of
/// the noise, which does not average out (as characterisability has it); elsewhere by twice what the noise of
/// so many rows leaves. A motion that only few rows tell of, a hundredth of them, can so be known.
[[nodiscard]] double needed_share(const SlipNoise& noise, double radius, std::size_t rows) noexcept;

}  // namespace pliant

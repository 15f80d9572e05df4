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
/// 2003).
struct WeakMotions {
  PlaneEquations equations;
  /// Of all small motions, the least share of a motion that telling rows see along their normals; the motion
  /// moves points by about one, a turn about the centre by one at `radius` metres from it.
  double held = 0;
};
[[nodiscard]] WeakMotions weigh_weak_motions(std::span<const PlaneRow> rows, const RobustMoments& robust,
                                             double radius) noexcept;

}  // namespace pliant

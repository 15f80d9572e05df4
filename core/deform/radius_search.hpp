// Where deformed points went (paper, section 3.3): the nearest free reading within a radius of where the
// rigid transform puts them.
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

struct RadiusSearchSettings {
  std::int32_t radius = 0;  ///< 1/16 mm
  int smoothing = 2;        ///< rounds in which a point takes its neighbours' mean offset
};

/// Sets `offset`, `position`, `match` and `residual` of the points labelled deformed: the nearest reading
/// that no rigid point matched, looked for around where the point was found last; points without one take the
/// mean offset of their neighbours. Offsets of all other observed points are cleared; those of points not
/// observed are kept. `taken`: one bit a pixel of the picture, scratch.
void search_deformed(const ModelTables& model, const Surface& surface, const Projector& projector,
                     const RegionSet& regions, const RadiusSearchSettings& settings,
                     std::span<std::uint32_t> taken, PointState& points) noexcept;

}  // namespace pliant

// Makes a rigid region of a connected group of outliers (paper, section 3.2).
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

/// Takes the largest connected group of points labelled deformed, fits its rigid transform robustly from
/// where its home region puts it (nearest readings within a third of the object's radius), and makes it
/// region `slot` when most of the group follows it as closely as rigid surface does.
bool split_outliers(const ModelTables& model, const Surface& surface, const Projector& projector,
                    const Tolerance& tolerance, std::uint32_t fewest_points, std::size_t slot,
                    RegionSet& regions, PointState& points) noexcept;

}  // namespace pliant

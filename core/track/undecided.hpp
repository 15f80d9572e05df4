// Points that more than one region explains go with the nearest that only one does.
#pragma once

#include "core/track/borders.hpp"
#include "core/track/sight.hpp"

namespace pliant {

/// A surface that slides along itself, such as a waist that turns, suits both regions beside a joint: its
/// readings do not tell where one ends. Points whose readings do, between the regions near them, are decided;
/// every other point that is seen and on its region goes over to the region of the decided point nearest
/// along the surface graph, where that region explains it, too. Away from `borders`, all are. Changes `home`;
/// uses `group` and `queue`.
void settle_undecided(const ModelTables& model, const PatchTables& patches, const RegionBorders& borders,
                      const Sighting& sighting, const RegionSet& regions, PointState& points) noexcept;

}  // namespace pliant

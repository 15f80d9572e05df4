// Holds still what only noise moves.
#pragma once

#include "core/track/track_state.hpp"

namespace pliant {

/// Takes each region's pose back towards its last one by a share that depends on how far it moved: a motion d
/// of its points is followed by d² / (d² + t²), with t half of the sensor's noise. A still object comes to
/// rest; one that moves by several t a frame is followed at once, with a lag below t.
void hold_steady(const ModelTables& model, const Surface& surface, RegionSet& regions) noexcept;

}  // namespace pliant

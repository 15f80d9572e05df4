// Colours of deformed points by how far they moved, the same in every picture and in the web viewer.
#pragma once

#include <span>

#include "drivers/geometry_files/region_colours.hpp"

namespace pliant {

/// From pale yellow at 0 to dark red at `most` and beyond (both metres).
[[nodiscard]] RegionColour displacement_colour(double displacement, double most);

/// The scale's end for these lengths: what 95 % of those above 0 keep to, rounded up to 1, 2 or 5 times a
/// power of ten, at least 5 mm. Metres.
[[nodiscard]] double displacement_scale(std::span<const float> lengths);

}  // namespace pliant

// The colours of regions, the same in every picture and file.
#pragma once

#include <cstdint>

namespace pliant {

struct RegionColour {
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// Colour of a label: a region's id (0 the base; ids beyond the palette repeat its other colours), kDeformed
/// or kNotObserved. Told apart with any kind of colour vision: Okabe and Ito's colours (Color Universal
/// Design, 2008), continued with the muted scheme of Paul Tol (Colour Schemes, SRON/EPS/TN/09-002).
[[nodiscard]] RegionColour region_colour(int label);

/// The word for a label in a key: "base", "region 3", "deformed", "not observed". Valid for labels >= -2.
[[nodiscard]] const char* region_word(int label);

}  // namespace pliant

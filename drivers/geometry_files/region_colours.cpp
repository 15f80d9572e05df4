#include "drivers/geometry_files/region_colours.hpp"

#include <array>

#include "core/track_result.hpp"

namespace pliant {

RegionColour region_colour(int label) {
  if (label == kDeformed) return {213, 94, 0};                       // vermilion
  if (label == 0) return {0, 114, 178};                              // blue
  if (label <= kNotObserved) return {80, 80, 80};                    // dark grey
  constexpr std::array<RegionColour, 7> others = {{{240, 228, 66},   // yellow
                                                   {0, 158, 115},    // bluish green
                                                   {204, 121, 167},  // reddish purple
                                                   {86, 180, 233},   // sky blue
                                                   {51, 34, 136},    // indigo
                                                   {221, 204, 119},  // sand
                                                   {136, 34, 85}}};  // wine
  return others[static_cast<std::size_t>(label - 1) % others.size()];
}

const char* region_word(int label) {
  constexpr std::array<const char*, 10> words = {"not observed", "deformed", "base",     "region 1",
                                                 "region 2",     "region 3", "region 4", "region 5",
                                                 "region 6",     "region 7"};
  if (label < kNotObserved) return words[0];
  const auto place = static_cast<std::size_t>(label - kNotObserved);
  return place < words.size() ? words[place] : "another region";
}

}  // namespace pliant

#include "firmware-app/pictures/displacement_colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace pliant {

RegionColour displacement_colour(double displacement, double most) {
  // Brewer's YlOrRd, lightest to darkest: ordered by lightness, so it reads without colour vision too.
  constexpr std::array<RegionColour, 4> kStops = {
      {{255, 237, 160}, {254, 178, 76}, {240, 59, 32}, {128, 0, 38}}};
  const double at = most > 0 ? std::clamp(displacement / most, 0.0, 1.0) * (kStops.size() - 1) : 0;
  const auto low = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double t = at - static_cast<double>(low);
  const auto mix = [t](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + t * (b - a)));
  };
  return {mix(kStops[low].red, kStops[low + 1].red), mix(kStops[low].green, kStops[low + 1].green),
          mix(kStops[low].blue, kStops[low + 1].blue)};
}

double displacement_scale(std::span<const float> lengths) {
  // The largest but for one in twenty: a few points gone astray must not make the rest pale.
  std::vector<float> sorted;
  for (const float length : lengths)
    if (std::isfinite(length) && length > 0) sorted.push_back(length);
  double most = 0;
  if (!sorted.empty()) {
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) * 19 / 20);
    std::nth_element(sorted.begin(), at, sorted.end());
    most = static_cast<double>(*at);
  }
  for (double decade = 0.001; decade < 10; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (step * decade >= std::max(most, 0.005) - 1e-9) return step * decade;
  return 10;
}

}  // namespace pliant

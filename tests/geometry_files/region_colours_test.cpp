#include "drivers/geometry_files/region_colours.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace pliant {
namespace {

using Colour = std::array<double, 3>;

double linear(int value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// As seen by people without red or green cones (Viénot, Brettel, Mollon: Digital video colourmaps for
/// checking the legibility of displays by dichromats, 1999), or with all of them.
Colour seen(const RegionColour& c, int missing) {
  const double r = linear(c.red), g = linear(c.green), b = linear(c.blue);
  if (missing == 0)
    return {0.11238 * r + 0.88762 * g, 0.11238 * r + 0.88762 * g, 0.00401 * r - 0.00401 * g + b};
  if (missing == 1)
    return {0.29275 * r + 0.70725 * g, 0.29275 * r + 0.70725 * g, -0.02234 * r + 0.02234 * g + b};
  return {r, g, b};
}

/// Distance in CIE L*a*b*.
Colour lab(const Colour& c) {
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505);
  const double y = f(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
  const double z = f((0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

TEST(RegionColours, AreToldApartWithEveryColourVision) {
  for (int missing = 0; missing < 3; ++missing)
    for (int a = -2; a <= 3; ++a)
      for (int b = a + 1; b <= 3; ++b) {
        const Colour p = lab(seen(region_colour(a), missing)), q = lab(seen(region_colour(b), missing));
        const double distance = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
        EXPECT_GT(distance, 15) << region_word(a) << " and " << region_word(b)
                                << ", cones missing: " << missing;
      }
}

TEST(RegionColours, EveryLabelHasAColourAndAWord) {
  EXPECT_EQ(std::string(region_word(-2)), "not observed");
  EXPECT_EQ(std::string(region_word(-1)), "deformed");
  EXPECT_EQ(std::string(region_word(0)), "base");
  EXPECT_EQ(std::string(region_word(7)), "region 7");
  for (int label = -128; label <= 127; ++label) {
    const RegionColour c = region_colour(label);
    EXPECT_GT(c.red + c.green + c.blue, 0);
    EXPECT_NE(std::string(region_word(label)), "");
  }
}

}  // namespace
}  // namespace pliant

// A colour picture to draw on.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/geometry_files/region_colours.hpp"

namespace pliant {

/// Drawing outside the picture does nothing.
class Canvas {
 public:
  Canvas(int width, int height)
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3) {}

  /// `opacity` 0 to 1.
  void set(int u, int v, RegionColour colour, double opacity = 1);
  void disc(double u, double v, double radius, RegionColour colour, double opacity);
  void box(int u, int v, int width, int height, RegionColour colour, double opacity = 1);
  void line(double u0, double v0, double u1, double v1, RegionColour colour);
  /// Upper left corner at (u, v); every pixel of a letter becomes scale x scale pixels.
  void text(int u, int v, std::string_view words, RegionColour colour, int scale = 2);
  [[nodiscard]] static int text_width(std::string_view words, int scale = 2);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Three bytes a pixel, rows from the top.
  [[nodiscard]] const std::vector<std::uint8_t>& rgb() const { return pixels_; }

 private:
  int width_, height_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace pliant

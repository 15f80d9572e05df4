#include "firmware-app/pictures/canvas.hpp"

#include <algorithm>
#include <cmath>

#include "firmware-app/pictures/font.hpp"

namespace pliant {

void Canvas::set(int u, int v, RegionColour colour, double opacity) {
  if (u < 0 || v < 0 || u >= width_ || v >= height_) return;
  std::uint8_t* pixel = &pixels_[(static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                                  static_cast<std::size_t>(u)) *
                                 3];
  const std::uint8_t wanted[3] = {colour.red, colour.green, colour.blue};
  for (int i = 0; i < 3; ++i)
    pixel[i] = static_cast<std::uint8_t>(std::lround(pixel[i] + opacity * (wanted[i] - pixel[i])));
}

void Canvas::disc(double u, double v, double radius, RegionColour colour, double opacity) {
  if (!(std::fabs(u) < 1e5) || !(std::fabs(v) < 1e5)) return;
  for (int y = static_cast<int>(std::ceil(v - radius)); y <= v + radius; ++y)
    for (int x = static_cast<int>(std::ceil(u - radius)); x <= u + radius; ++x)
      if ((x - u) * (x - u) + (y - v) * (y - v) <= radius * radius) set(x, y, colour, opacity);
}

void Canvas::box(int u, int v, int width, int height, RegionColour colour, double opacity) {
  for (int y = v; y < v + height; ++y)
    for (int x = u; x < u + width; ++x) set(x, y, colour, opacity);
}

void Canvas::line(double u0, double v0, double u1, double v1, RegionColour colour) {
  const double length = std::hypot(u1 - u0, v1 - v0);
  if (!(length < 1e5)) return;
  const int steps = std::max(1, static_cast<int>(2 * length));
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    disc(u0 + t * (u1 - u0), v0 + t * (v1 - v0), 1, colour, 1);
  }
}

void Canvas::text(int u, int v, std::string_view words, RegionColour colour, int scale) {
  for (const char character : words) {
    const Glyph& rows = glyph(character);
    for (int y = 0; y < kGlyphHeight; ++y)
      for (int x = 0; x < kGlyphWidth; ++x)
        if ((rows[static_cast<std::size_t>(y)] >> (kGlyphWidth - 1 - x) & 1) != 0)
          box(u + x * scale, v + y * scale, scale, scale, colour);
    u += (kGlyphWidth + 1) * scale;
  }
}

int Canvas::text_width(std::string_view words, int scale) {
  return static_cast<int>(words.size()) * (kGlyphWidth + 1) * scale;
}

}  // namespace pliant

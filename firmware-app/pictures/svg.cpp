#include "firmware-app/pictures/svg.hpp"

#include <fmt/format.h>

#include <cmath>

namespace pliant {

namespace {

std::string escaped(std::string_view words) {
  std::string out;
  for (const char c : words) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else if (static_cast<unsigned char>(c) >= 0x20) {
      out += c;
    }
  }
  return out;
}

}  // namespace

Svg::Svg(double width, double height) : width_(width), height_(height) {}

void Svg::line(double x0, double y0, double x1, double y1, std::string_view colour, double width) {
  body_ +=
      fmt::format(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}" stroke-width="{}"/>)"
                  "\n",
                  x0, y0, x1, y1, colour, width);
}

void Svg::box(double x, double y, double width, double height, std::string_view colour) {
  body_ += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"/>)"
                       "\n",
                       x, y, width, height, colour);
}

void Svg::circle(double x, double y, double radius, std::string_view colour) {
  body_ += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="{}"/>)"
                       "\n",
                       x, y, radius, colour);
}

void Svg::text(double x, double y, std::string_view words, std::string_view anchor, double size,
               std::string_view colour) {
  body_ += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" font-size="{}" fill="{}">{}</text>)"
                       "\n",
                       x, y, anchor, size, colour, escaped(words));
}

void Svg::add_to_path(double x, double y) {
  path_ += fmt::format("{}{:.2f},{:.2f}", path_.empty() ? "" : " ", x, y);
}

void Svg::end_path(std::string_view colour, double width) {
  if (!path_.empty())
    body_ += fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="{}"/>)"
                         "\n",
                         path_, colour, width);
  path_.clear();
}

std::string Svg::finished() const {
  return fmt::format(
             R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}" )"
             R"(font-family="sans-serif">)"
             "\n"
             R"(<rect width="100%" height="100%" fill="white"/>)"
             "\n",
             width_, height_) +
         body_ + "</svg>\n";
}

double round_step(double range, int most) {
  double decade = std::pow(10, std::floor(std::log10(std::fmax(range, 1e-12) / most)));
  for (;; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (range / (step * decade) <= most) return step * decade;
}

}  // namespace pliant

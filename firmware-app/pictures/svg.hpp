// A plot as an SVG text.
#pragma once

#include <string>
#include <string_view>

namespace pliant {

/// Lengths in pixels, from the upper left corner.
class Svg {
 public:
  Svg(double width, double height);
  void line(double x0, double y0, double x1, double y1, std::string_view colour, double width = 1);
  void box(double x, double y, double width, double height, std::string_view colour);
  void circle(double x, double y, double radius, std::string_view colour);
  /// `anchor`: start, middle or end. `words` may hold any characters.
  void text(double x, double y, std::string_view words, std::string_view anchor = "start", double size = 13,
            std::string_view colour = "#222");
  /// Points are added one by one; a path is drawn by end_path().
  void add_to_path(double x, double y);
  void end_path(std::string_view colour, double width = 1.5);
  /// The whole file.
  [[nodiscard]] std::string finished() const;

 private:
  std::string body_, path_;
  double width_, height_;
};

/// A round step (1, 2 or 5 times a power of ten) that divides `range` into at most `most` parts.
[[nodiscard]] double round_step(double range, int most);

}  // namespace pliant

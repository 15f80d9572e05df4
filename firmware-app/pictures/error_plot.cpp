#include <fmt/format.h>

#include <algorithm>

#include "firmware-app/pictures/stats_plot.hpp"
#include "firmware-app/pictures/svg.hpp"
#include "firmware-app/pictures/trajectory_errors.hpp"

namespace pliant {

namespace {

constexpr double kLeft = 70, kRight = 30, kHeight = 100;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// One curve with its scales.
void draw_curve(const std::vector<PoseError>& errors, const std::vector<double>& values, const char* what,
                const char* unit, const char* colour, double top, Svg& svg) {
  const double width = kPlotWidth - kLeft - kRight, bottom = top + kHeight;
  const double end = std::max(errors.back().seconds, 0.1);
  const double most = std::max(*std::max_element(values.begin(), values.end()), 1e-6);
  const double step = round_step(most, 4);
  const double high = step * static_cast<double>(static_cast<int>(most / step) + 1);
  const auto x_of = [&](double seconds) { return kLeft + width * seconds / end; };
  const auto y_of = [&](double value) { return bottom - kHeight * value / high; };
  svg.text(12, top - 10,
           fmt::format("{}: median {:.3g} {}, largest {:.3g} {}", what, median(values), unit, most, unit),
           "start", 14);
  for (double value = 0; value < high + step / 2; value += step) {
    svg.line(kLeft, y_of(value), kPlotWidth - kRight, y_of(value), "#ddd");
    svg.text(kLeft - 6, y_of(value) + 4, fmt::format("{:g}", value), "end", 12, "#555");
  }
  const double time_step = round_step(end, 10);
  for (double seconds = 0; seconds <= end; seconds += time_step)
    svg.text(x_of(seconds), bottom + 16, fmt::format("{:g} s", seconds), "middle", 12, "#555");
  // A gap in the path is a gap in the curve.
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (i > 0 && errors[i].seconds - errors[i - 1].seconds > 0.5) svg.end_path(colour);
    svg.add_to_path(x_of(errors[i].seconds), y_of(values[i]));
  }
  svg.end_path(colour);
}

}  // namespace

void draw_error_plot(const std::vector<PoseError>& errors, double top, Svg& svg) {
  std::vector<double> shift, angle;
  for (const PoseError& error : errors) {
    shift.push_back(error.shift * 1000);
    angle.push_back(error.angle);
  }
  draw_curve(errors, shift, "position error", "mm", "#0072b2", top + 40, svg);
  draw_curve(errors, angle, "angle error", "degrees", "#d55e00", top + 40 + kHeight + 60, svg);
}

}  // namespace pliant

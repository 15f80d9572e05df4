// The times of a run as a plot.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "drivers/common/result.hpp"

namespace pliant {

struct StageBar {
  std::string name;
  double median_us = 0, p99_us = 0, max_us = 0;
};

/// What is plotted of a file that `pliant run --stats` wrote.
struct StatsSummary {
  std::vector<StageBar> bars;  ///< stages, the whole frame, the latency; those that took no time are left out
  std::int64_t frames = 0, tracked = 0, lost = 0, searching = 0, dropped = 0, bad_frames = 0;
  double rss_bytes = 0;
};

/// ErrorKind::bad_input names `name` and what is missing.
[[nodiscard]] Result<StatsSummary> read_stats(std::string_view json, std::string_view name);

class Svg;
inline constexpr double kPlotWidth = 860;
[[nodiscard]] double stats_plot_height(const StatsSummary& stats);
/// Median as a bar, 99th percentile and maximum as marks, on a logarithmic scale; from `top` down.
void draw_stats_plot(const StatsSummary& stats, std::string_view title, double top, Svg& svg);

}  // namespace pliant

#include "firmware-app/pictures/stats_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "firmware-app/pictures/svg.hpp"

namespace pliant {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeft = 110, kRight = 250, kHead = 62, kRowHeight = 26, kFoot = 44;

constexpr const char *kBarColour = "#56b4e9", *kSumColour = "#0072b2", *kP99Colour = "#d55e00",
                     *kMaxColour = "#222";

std::string time_text(double us) {
  return us >= 1000 ? fmt::format("{:.2f} ms", us / 1000) : fmt::format("{:.0f} \u00b5s", us);
}

StageBar bar_of(const std::string& name, const Json& times) {
  return {name, times.at("median_us").get<double>(), times.at("p99_us").get<double>(),
          times.at("max_us").get<double>()};
}

}  // namespace

Result<StatsSummary> read_stats(std::string_view json, std::string_view name) {
  try {
    const Json root = Json::parse(json);
    StatsSummary stats;
    for (const auto& [stage, times] : root.at("stages").items()) stats.bars.push_back(bar_of(stage, times));
    stats.bars.push_back(bar_of("latency", root.at("latency_us")));
    std::erase_if(stats.bars, [](const StageBar& bar) { return !(bar.max_us > 0); });
    for (const auto& [key, value] : {std::pair{"frames", &stats.frames},
                                     {"tracked", &stats.tracked},
                                     {"lost", &stats.lost},
                                     {"searching", &stats.searching},
                                     {"dropped", &stats.dropped},
                                     {"bad_frames", &stats.bad_frames}})
      *value = root.at(key).get<std::int64_t>();
    stats.rss_bytes = root.at("rss_bytes").get<double>();
    return stats;
  } catch (const Json::exception&) {
    return Error{ErrorKind::bad_input,
                 fmt::format("{} holds no figures of a run; 'pliant run --stats FILE' writes them", name)};
  }
}

double stats_plot_height(const StatsSummary& stats) {
  return kHead + kRowHeight * static_cast<double>(stats.bars.size()) + kFoot;
}

void draw_stats_plot(const StatsSummary& stats, std::string_view title, double top, Svg& svg) {
  const double width = kPlotWidth - kLeft - kRight;
  double least = 1e9, most = 1;
  for (const StageBar& bar : stats.bars) {
    if (bar.median_us > 0) least = std::min(least, bar.median_us);
    most = std::max(most, bar.max_us);
  }
  const double low = std::floor(std::log10(std::max(std::min(least, most) * 0.8, 0.1)));
  const double high = std::max(std::ceil(std::log10(most)), low + 1);
  const auto x_of = [&](double us) {
    return kLeft + width * std::clamp((std::log10(std::max(us, 1e-3)) - low) / (high - low), 0.0, 1.0);
  };
  const double bottom = top + kHead + kRowHeight * static_cast<double>(stats.bars.size());

  svg.text(12, top + 24, title, "start", 17);
  svg.text(12, top + 44,
           fmt::format("{} frames: {} tracked, {} searching, {} lost; {} dropped, {} bad; {:.1f} MB resident",
                       stats.frames, stats.tracked, stats.searching, stats.lost, stats.dropped,
                       stats.bad_frames, stats.rss_bytes / 1e6));
  for (double decade = low; decade <= high; ++decade) {
    const double x = x_of(std::pow(10, decade));
    svg.line(x, top + kHead - 4, x, bottom + 4, "#ccc");
    svg.text(x, bottom + 20,
             decade < 3   ? fmt::format("{:g} \u00b5s", std::pow(10, decade))
             : decade < 6 ? fmt::format("{:g} ms", std::pow(10, decade - 3))
                          : fmt::format("{:g} s", std::pow(10, decade - 6)),
             "middle", 12, "#555");
  }
  const auto column = [&](int number, double at, const std::string& words) {
    svg.text(kPlotWidth - kRight + 80 * number, at, words, "end", 12, "#555");
  };
  column(1, top + kHead - 6, "median");
  column(2, top + kHead - 6, "p99");
  column(3, top + kHead - 6, "max");
  // Each heading with its mark.
  const auto mark_at = [](int number, double word_width) {
    return kPlotWidth - kRight + 80 * number - word_width - 8;
  };
  const double mark_y = top + kHead - 10;
  svg.box(mark_at(1, 44) - 12, mark_y - 5, 12, 10, kBarColour);
  svg.line(mark_at(2, 24), mark_y - 7, mark_at(2, 24), mark_y + 7, kP99Colour, 3);
  svg.circle(mark_at(3, 27), mark_y, 3.5, kMaxColour);
  double y = top + kHead;
  for (const StageBar& bar : stats.bars) {
    const bool sum = bar.name == "total" || bar.name == "latency";
    svg.text(kLeft - 8, y + 17, bar.name, "end");
    svg.box(kLeft, y + 5, x_of(bar.median_us) - kLeft, kRowHeight - 10, sum ? kSumColour : kBarColour);
    svg.line(x_of(bar.p99_us), y + 3, x_of(bar.p99_us), y + kRowHeight - 3, kP99Colour, 3);
    svg.circle(x_of(bar.max_us), y + kRowHeight / 2, 3.5, kMaxColour);
    column(1, y + 17, time_text(bar.median_us));
    column(2, y + 17, time_text(bar.p99_us));
    column(3, y + 17, time_text(bar.max_us));
    y += kRowHeight;
  }
}

}  // namespace pliant

// pliant plot: a run's figures as a picture.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "drivers/common/printable.hpp"
#include "drivers/geometry_files/atomic_file.hpp"
#include "drivers/recording/text_file.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/commands/option_checks.hpp"
#include "firmware-app/pictures/stats_plot.hpp"
#include "firmware-app/pictures/svg.hpp"
#include "firmware-app/pictures/trajectory_errors.hpp"

namespace pliant {

namespace {

struct PlotOptions {
  std::string stats, output, trajectory, truth;
};

int plot(const PlotOptions& options) {
  if (options.trajectory.empty() != options.truth.empty())
    return report({ErrorKind::bad_input, "errors need both --trajectory and --truth"});
  const std::string output = options.output.empty()
                                 ? std::filesystem::path(options.stats).replace_extension(".svg").string()
                                 : options.output;
  const Outcome apart = NamedFiles()
                            .reads("STATS", options.stats)
                            .reads("--trajectory", options.trajectory)
                            .reads("--truth", options.truth)
                            .writes(options.output.empty() ? "the picture beside STATS" : "--output", output)
                            .apart();
  if (!apart) return report(apart.error());
  constexpr std::size_t kMostBytes = 16U << 20;
  const Result<std::string> text = read_text_file(options.stats, kMostBytes);
  if (!text) return report({ErrorKind::bad_input, "cannot read the figures " + text.error().message});
  const Result<StatsSummary> stats = read_stats(*text, options.stats);
  if (!stats) return report(stats.error());
  std::vector<PoseError> errors;
  if (!options.truth.empty()) {
    Result<std::vector<PoseError>> read = trajectory_errors(options.trajectory, options.truth);
    if (!read) return report(read.error());
    errors = std::move(*read);
  }

  const double height = stats_plot_height(*stats);
  Svg svg(kPlotWidth, height + (errors.empty() ? 0 : kErrorPlotHeight));
  // A file's name may be any bytes; an SVG is UTF-8.
  constexpr std::size_t kLongestName = 255;
  draw_stats_plot(*stats, printable(std::filesystem::path(options.stats).filename().string(), kLongestName),
                  0, svg);
  if (!errors.empty()) draw_error_plot(errors, height, svg);
  const std::string picture = svg.finished();
  if (const Outcome written = write_whole_file(output.c_str(), std::as_bytes(std::span(picture)), false);
      !written)
    return report(written.error());
  return print(output + "\n") ? kExitDone : kExitFailed;
}

}  // namespace

void add_plot(CLI::App& program, Work& work) {
  CLI::App* app =
      program.add_subcommand("plot", "Draw a run's times, and its errors where the truth is known");
  auto options = std::make_shared<PlotOptions>();
  app->add_option("STATS", options->stats, "File written by 'pliant run --stats'")->required();
  app->add_option("-o,--output", options->output, "SVG file to write; left out: beside STATS")
      ->check(names_a_file())
      ->type_name("P.svg");
  app->add_option("--trajectory", options->trajectory, "Path written by 'pliant run --trajectory'")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--truth", options->truth, "The true path, such as a recording's groundtruth.txt")
      ->check(names_a_file())
      ->type_name("FILE");
  app->callback([options, &work] { work = [options] { return plot(*options); }; });
}

}  // namespace pliant

// pliant export: what a tracker published, out of a log of lcm-logger, as files that other programs open.
#include <fmt/format.h>

#include <memory>

#include "drivers/model_files/model_file.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/commands/option_checks.hpp"
#include "firmware-app/export/exporters.hpp"

namespace pliant {

namespace {

struct ExportOptions {
  std::string log, prefix = "PLIANT", model, tum, ply, csv, mcap;
};

ReceivedModel received(const ModelFile& file) {
  const ModelView& view = file.view();
  ReceivedModel model;
  model.model_id = static_cast<std::int64_t>(view.header().checksum);
  model.spacing = static_cast<float>(view.spacing());
  model.points.assign(view.positions().begin(), view.positions().end());
  return model;
}

int export_log(const ExportOptions& options) {
  if (options.tum.empty() && options.ply.empty() && options.csv.empty() && options.mcap.empty())
    return report({ErrorKind::bad_input, "nothing to write: give --tum, --ply, --csv or --mcap"});
  const Outcome apart = NamedFiles()
                            .reads("LOG", options.log)
                            .reads("--model", options.model)
                            .writes("--tum", options.tum)
                            .writes("--ply", options.ply)
                            .writes_tables("--csv", options.csv)
                            .writes("--mcap", options.mcap)
                            .apart();
  if (!apart) return report(apart.error());
  // Read before anything is written, so that a wrong name leaves no empty files.
  Result<std::vector<ReceivedModel>> models = models_in_log(options.log, options.prefix);
  if (!models) return report(models.error());
  if (!options.model.empty()) {
    const Result<ModelFile> file = ModelFile::open(options.model);
    if (!file) return report(file.error());
    models->insert(models->begin(), received(*file));
  }
  if (const Result<LogFigures> checked = walk_log(options.log, options.prefix, {}, {}); !checked)
    return report(checked.error());

  std::vector<std::unique_ptr<LogExporter>> owned;
  std::vector<LogExporter*> exporters;
  const auto add = [&](const std::string& path, auto make) -> Outcome {
    if (path.empty()) return success();
    Result<std::unique_ptr<LogExporter>> made = make(path);
    if (!made) return made.error();
    exporters.push_back(made->get());
    owned.push_back(std::move(*made));
    return success();
  };
  for (const Outcome& added : {add(options.tum, export_tum), add(options.ply, export_ply),
                               add(options.csv, export_csv), add(options.mcap, export_mcap)})
    if (!added) return report(added.error());

  const Result<LogFigures> figures = walk_log(options.log, options.prefix, *models, exporters);
  if (!figures) return report(figures.error());
  std::string text = fmt::format("{} frames, {} tracked\n", figures->frames, figures->tracked);
  for (const LogExporter* exporter : exporters) text += exporter->summary() + "\n";
  if (!print(text)) return kExitFailed;
  if (figures->incomplete > 0)
    print_warning(
        fmt::format("{} frames or pictures are not whole in the log and were left out; while recording, "
                    "more room for messages on their way helps: sudo sysctl -w "
                    "net.core.rmem_max=2097152 net.core.rmem_default=2097152",
                    figures->incomplete));
  if (figures->garbage > 0)
    print_warning(fmt::format("{} messages of other types or damaged were left out", figures->garbage));
  if (figures->damages > 0)
    print_warning(fmt::format("{} damaged stretch{} of the log {} left out; what is whole was written",
                              figures->damages, figures->damages == 1 ? "" : "es",
                              figures->damages == 1 ? "was" : "were"));
  return kExitDone;
}

}  // namespace

void add_export(CLI::App& program, Work& work) {
  CLI::App* app = program.add_subcommand(
      "export", "Write what a log of lcm-logger holds as files that other programs open");
  auto options = std::make_shared<ExportOptions>();
  app->add_option("LOG", options->log, "Log file, as 'lcm-logger' or --lcm-url 'file://LOG?mode=w' writes it")
      ->required();
  app->add_option("--tum", options->tum, "The base region's path, TUM format (evo)")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--ply", options->ply, "A points file per tracked frame (MeshLab, CloudCompare)")
      ->check(names_a_folder())
      ->type_name("DIR");
  app->add_option("--csv", options->csv, "Tables of frames, regions, deformed points and statuses")
      ->check(names_a_folder())
      ->type_name("DIR");
  app->add_option("--mcap", options->mcap, "Transforms, points, depth and statuses in one file (Foxglove)")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--prefix", options->prefix, "First word of the channels' names")
      ->capture_default_str()
      ->type_name("PREFIX");
  app->add_option("--model", options->model, "Model file, where the log does not hold the model")
      ->check(names_a_file())
      ->type_name("FILE");
  app->callback([options, &work] { work = [options] { return export_log(*options); }; });
}

}  // namespace pliant

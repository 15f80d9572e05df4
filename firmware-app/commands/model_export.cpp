// pliant model export: a model's points and normals as a PLY file, in the model's order.
#include <memory>

#include "drivers/geometry_files/geometry.hpp"
#include "drivers/model_files/model_file.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/commands/option_checks.hpp"

namespace pliant {

namespace {

struct ExportOptions {
  std::string input, output;
};

int export_model(const ExportOptions& options) {
  if (const Outcome apart =
          NamedFiles().reads("FILE", options.input).writes("--output", options.output).apart();
      !apart)
    return report(apart.error());
  const Result<ModelFile> file = ModelFile::open(options.input);
  if (!file) return report(file.error());
  const ModelView& view = file->view();
  Geometry geometry;
  geometry.vertices.assign(view.positions().begin(), view.positions().end());
  geometry.normals.reserve(view.size());
  for (const Normal16& n : view.normals()) {
    constexpr float kOne = 16384;
    geometry.normals.push_back(
        {static_cast<float>(n.x) / kOne, static_cast<float>(n.y) / kOne, static_cast<float>(n.z) / kOne});
  }
  if (const Outcome written = write_ply(options.output, geometry); !written) return report(written.error());
  return kExitDone;
}

}  // namespace

void add_model_export(CLI::App& model, Work& work) {
  CLI::App* app = model.add_subcommand("export", "Write a model's points and normals as a PLY file");
  auto options = std::make_shared<ExportOptions>();
  app->add_option("FILE", options->input, "Model file")->required();
  app->add_option("-o,--output", options->output, "PLY file to write")
      ->required()
      ->check(names_a_file())
      ->type_name("P.ply");
  app->callback([options, &work] { work = [options] { return export_model(*options); }; });
}

}  // namespace pliant

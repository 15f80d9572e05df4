// pliant model build: a mesh or cloud becomes a model file.
#include <fmt/format.h>

#include <memory>

#include "drivers/model_files/describe_model.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/inputs.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/commands/option_checks.hpp"

namespace pliant {

namespace {

struct BuildOptions {
  std::string input, output, units = "m";
  double spacing = 0, material = ModelBuildSettings().material;
};

int build(const BuildOptions& options) {
  if (const Outcome apart =
          NamedFiles().reads("INPUT", options.input).writes("--output", options.output).apart();
      !apart)
    return report(apart.error());
  LiveLine line;
  line.show("reading " + options.input);
  const Result<Geometry> geometry = load_geometry(options.input);
  line.clear();
  if (!geometry) return report(geometry.error());
  ModelBuildSettings settings;
  settings.metres_per_unit = options.units == "mm" ? 0.001 : 1;
  settings.spacing = options.spacing;
  settings.material = options.material;
  line.show("building the model: points, normals, descriptors");
  const Result<BuiltModel> built = build_model(*geometry, settings);
  line.clear();
  if (!built)
    return report({built.error().kind, fmt::format("{}: {}", options.input, built.error().message)});
  for (const std::string& warning : built->warnings) print_warning(options.input + ": " + warning);
  // Before a model that is there gives way to it.
  ModelView view;
  if (const ModelFault fault = ModelView::open(built->image, view); fault != ModelFault::none)
    return report({ErrorKind::write, fmt::format("internal error: the new model {}", describe(fault))});
  if (const Outcome written = write_model(options.output, built->image); !written)
    return report(written.error());
  return print(describe_model(view)) ? kExitDone : kExitFailed;
}

}  // namespace

void add_model_build(CLI::App& model, Work& work) {
  CLI::App* app = model.add_subcommand("build", "Make a model file from a mesh or a cloud");
  auto options = std::make_shared<BuildOptions>();
  app->add_option("INPUT", options->input,
                  "Mesh (PLY, OBJ, STL, OFF) or cloud (PLY, PCD), or simulated:cushion|figure|box")
      ->required();
  app->add_option("-o,--output", options->output, "Model file to write")
      ->required()
      ->check(names_a_file())
      ->type_name("OUT.model");
  app->add_option("--units", options->units, "Unit of the input's coordinates")
      ->check(CLI::IsMember({"m", "mm"}).description(""))
      ->type_name("m|mm")
      ->capture_default_str();
  app->add_option("--spacing", options->spacing,
                  "Distance between the model's points, metres; left out: derived from the surface")
      ->check(number_within(1e-5, 1))
      ->type_name("M");
  app->add_option(
         "--material", options->material,
         "How easily the object stretches, 0 stiff like leather to 1 soft like fleece; 'track.material' "
         "in a config overrides it")
      ->check(number_within(0, 1))
      ->type_name("0..1")
      ->capture_default_str();
  app->callback([options, &work] { work = [options] { return build(*options); }; });
}

}  // namespace pliant

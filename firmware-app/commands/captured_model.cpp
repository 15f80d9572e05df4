#include "firmware-app/commands/captured_model.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "drivers/model_files/captured_mesh.hpp"
#include "drivers/model_files/describe_model.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/model_file.hpp"
#include "firmware-app/commands/capture_guide.hpp"
#include "firmware-app/commands/console.hpp"

namespace pliant {

namespace {

/// The model, or the same beside the temporary files where its own place cannot be written: a capture is not
/// repeated at will.
int keep_model(const std::string& output, const BuiltModel& built) {
  const Outcome written = write_model(output, built.image);
  if (written) return kExitDone;
  std::error_code fault;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(fault);
  const std::filesystem::path refuge =
      folder / (std::filesystem::path(output).filename().string() + ".rescued");
  if (fault || !write_model(refuge, built.image)) return report(written.error());
  return report({ErrorKind::write,
                 fmt::format("{}; the model is kept as {}", written.error().message, refuge.string())});
}

}  // namespace

int write_captured_model(const CapturedModelOptions& options, const ObjectCapture& capture,
                         const JointFit& joint) {
  CapturedMeshSettings cleaning;
  cleaning.table_height = capture.table_height() + options.clearance;
  const Geometry mesh = captured_mesh(capture.volume(), cleaning);
  if (mesh.triangles.empty())
    return report(
        {ErrorKind::bad_input, "too little of the object was seen to make a model of; show it longer"});
  int surface_code = kExitDone;
  if (!options.ply.empty())
    if (const Outcome written = write_ply(options.ply, mesh); !written)
      surface_code = report(written.error());
  ModelBuildSettings settings;
  settings.wound_outward = true;
  settings.spacing = captured_spacing(mesh, options.sigma);
  settings.material = options.material;
  const Coverage& coverage = capture.coverage();
  // Half a turn and more shows some of every side.
  settings.front_only = coverage.sectors_seen() <= Coverage::kSectors / 2;
  const Result<BuiltModel> built = build_model(mesh, settings);
  if (!built) return report({built.error().kind, "the captured surface " + built.error().message});
  for (const std::string& warning : built->warnings) print_warning(warning);
  // Before a model that is there gives way to it.
  ModelView view;
  if (const ModelFault fault = ModelView::open(built->image, view); fault != ModelFault::none)
    return report({ErrorKind::write, fmt::format("internal error: the new model {}", describe(fault))});
  const int model_code = keep_model(options.output, *built);
  const int code = model_code != kExitDone ? model_code : surface_code;
  const CaptureFigures& figures = capture.figures();
  std::string text = fmt::format("fused: {} of {} pictures, {} kept views\n", figures.fused, figures.frames,
                                 capture.keyframes().all().size());
  if (joint.pairs > 0)
    text += fmt::format("views fit each other: within {:.2f} mm, {:.2f} mm before the drift was closed\n",
                        1000 * joint.after, 1000 * joint.before);
  if (const std::string doubt = doubt_of_turning(figures, coverage); !doubt.empty()) print_warning(doubt);
  const std::string missing = sides_missing(coverage);
  text += fmt::format("seen: {} of {} sides{}\n", coverage.sectors_seen(), Coverage::kSectors,
                      missing.empty() ? "" : "; not " + missing);
  text += describe_model(view);
  return print(text) ? code : kExitFailed;
}

}  // namespace pliant

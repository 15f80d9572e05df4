// pliant model capture: the sensor itself makes the model, of an object that is turned before it, or around
// which it is carried.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "core/capture/object_capture.hpp"
#include "drivers/model_files/captured_mesh.hpp"
#include "drivers/model_files/describe_model.hpp"
#include "drivers/recording/pose_list.hpp"
#include "firmware-app/commands/capture_guide.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/inputs.hpp"
#include "firmware-app/pipeline/memory_block.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant {

namespace {

struct CaptureOptions {
  std::string source, output, ply, sensor, poses;
  std::vector<int> at;
  std::int64_t frames = -1;
  CaptureSettings capture;
  std::vector<StampedPose> known;  ///< what --poses names
};

constexpr double megabytes(std::size_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

/// How the pictures ended.
struct Taken {
  SourceEvent last = SourceEvent::end;
  std::string fault;
  std::int64_t bad_frames = 0;  ///< and those without a known pose, where poses were given
};

Taken take_pictures(DepthSource& source, const CaptureOptions& options, ObjectCapture& capture) {
  Taken taken;
  CaptureGuide guide(source.rate());
  LiveLine line;
  SourceItem item;
  std::int64_t count = 0;
  while (!StopSignal::requested() && (options.frames < 0 || count < options.frames)) {
    source.next(100, item);
    taken.last = item.event;
    if (!item.fault.empty()) taken.fault = item.fault;
    if (item.event == SourceEvent::end || item.event == SourceEvent::lost) break;
    if (item.event == SourceEvent::timeout) continue;
    ++count;
    if (item.event == SourceEvent::bad_frame) {
      ++taken.bad_frames;
      continue;
    }
    const StampedPose* const known =
        options.known.empty() ? nullptr
                              : pose_at(options.known, static_cast<double>(item.frame.utime) * 1e-6);
    if (!options.known.empty() && known == nullptr) {
      ++taken.bad_frames;
      continue;
    }
    guide.take(
        known != nullptr ? capture.process(item.frame, known->transform()) : capture.process(item.frame),
        capture.coverage());
    if (const std::string advice = guide.advice(); !advice.empty()) {
      line.clear();
      print_warning(advice);
    }
    line.show(guide.line());
  }
  line.clear();
  return taken;
}

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

int build_and_write(const CaptureOptions& options, const ObjectCapture& capture, const JointFit& joint) {
  CapturedMeshSettings cleaning;
  cleaning.table_height = capture.table_height() + options.capture.clearance;
  const Geometry mesh = captured_mesh(capture.volume(), cleaning);
  if (mesh.triangles.empty())
    return report(
        {ErrorKind::bad_input, "too little of the object was seen to make a model of; show it longer"});
  if (!options.ply.empty())
    if (const Outcome written = write_ply(options.ply, mesh); !written)
      print_warning(written.error().message);
  ModelBuildSettings settings;
  settings.wound_outward = true;
  const Coverage& coverage = capture.coverage();
  // Half a turn and more shows some of every side.
  settings.front_only = coverage.sectors_seen() <= Coverage::kSectors / 2;
  const Result<BuiltModel> built = build_model(mesh, settings);
  if (!built) return report({built.error().kind, "the captured surface " + built.error().message});
  for (const std::string& warning : built->warnings) print_warning(warning);
  const int code = keep_model(options.output, *built);
  ModelView view;
  if (const ModelFault fault = ModelView::open(built->image, view); fault != ModelFault::none)
    return report({ErrorKind::write, fmt::format("internal error: the new model {}", describe(fault))});
  const CaptureFigures& figures = capture.figures();
  std::string text = fmt::format("fused: {} of {} pictures, {} kept views\n", figures.fused, figures.frames,
                                 capture.keyframes().all().size());
  if (joint.pairs > 0)
    text += fmt::format("views fit each other: within {:.2f} mm, {:.2f} mm before the drift was closed\n",
                        1000 * joint.after, 1000 * joint.before);
  const std::string missing = sides_missing(coverage);
  text += fmt::format("seen: {} of {} sides{}\n", coverage.sectors_seen(), Coverage::kSectors,
                      missing.empty() ? "" : "; not " + missing);
  text += describe_model(view);
  return print(text) ? code : kExitFailed;
}

int capture(const CaptureOptions& given) {
  const StopSignal stop;
  CaptureOptions options = given;
  if (options.at.size() == 2) {
    options.capture.at_u = options.at[0];
    options.capture.at_v = options.at[1];
  }
  if (!options.poses.empty()) {
    Result<std::vector<StampedPose>> poses = read_pose_list(options.poses);
    if (!poses) return report(poses.error());
    options.known = std::move(*poses);
    if (options.known.empty()) return report({ErrorKind::bad_input, options.poses + ": holds no pose"});
  }
  SourceOptions source_options;
  if (!options.sensor.empty()) {
    const Result<SensorFile> sensor = read_sensor(options.sensor);
    if (!sensor) return report(sensor.error());
    source_options.sensor = *sensor;
  }
  Result<OpenSource> source = open_source(options.source, source_options);
  if (!source) return report(source.error());
  const Intrinsics& camera = source->source->intrinsics();
  const SensorDescription& sensor = source->source->sensor();
  if (options.capture.at_u >= camera.width || options.capture.at_v >= camera.height)
    return report({ErrorKind::bad_input,
                   fmt::format("--at {} {} lies outside the picture of {}x{}", options.capture.at_u,
                               options.capture.at_v, camera.width, camera.height)});
  const std::size_t bytes = ObjectCapture::workspace_bytes(camera, sensor, options.capture);
  Result<MemoryBlock> block = MemoryBlock::allocate(bytes);
  if (!block) return report(block.error());
  ObjectCapture object;
  if (const char* fault = object.start(camera, sensor, options.capture, block->bytes()))
    return report({ErrorKind::bad_input, fault});
  const VolumePlan plan = volume_plan(options.capture, sensor);
  if (!print(fmt::format("memory: {:.1f} MB, of it {:.1f} MB for {}x{}x{} voxels of {:.2f} mm\n",
                         megabytes(bytes), megabytes(plan.nodes() * sizeof(Voxel)), plan.cells, plan.cells,
                         plan.cells, 1000 * plan.voxel / kUnitsPerMetre)))
    return kExitFailed;

  const Taken taken = take_pictures(*source->source, options, object);
  source->source->close();
  if (object.figures().fused == 0) {
    if (taken.last == SourceEvent::lost) return report({ErrorKind::device, taken.fault});
    if (object.figures().frames == 0)
      return report({ErrorKind::bad_input, !options.known.empty() && taken.bad_frames > 0
                                               ? options.poses + ": no pose has the time of a frame"
                                           : taken.fault.empty() ? "the source has no frame"
                                                                 : "no frame is usable: " + taken.fault});
    print_warning("nothing was captured: in no picture did an object stand before the background");
    return kExitNotFound;
  }
  LiveLine line;
  line.show("closing the drift and fusing the views");
  const JointFit joint = object.finish();
  line.clear();
  const int code = build_and_write(options, object, joint);
  if (code == kExitDone && taken.last == SourceEvent::lost) return report({ErrorKind::device, taken.fault});
  return code;
}

}  // namespace

void add_model_capture(CLI::App& model, Work& work) {
  CLI::App* app =
      model.add_subcommand("capture", "Make a model file with the sensor: turn the object before it");
  auto options = std::make_shared<CaptureOptions>();
  app->add_option("--source", options->source, kSourceHelp)->required()->type_name("URI");
  app->add_option("-o,--output", options->output, "Model file to write")->required()->type_name("OUT.model");
  app->add_option("--size", options->capture.size, "Edge of the cube that holds the object, metres")
      ->check(CLI::Range(0.05, 1.0).description(""))
      ->type_name("M")
      ->capture_default_str();
  app->add_option("--voxel", options->capture.voxel,
                  "Edge of a voxel, metres; left out: what the sensor's noise allows to tell apart")
      ->check(CLI::Range(0.0005, 0.02).description(""))
      ->type_name("M");
  app->add_option("--clearance", options->capture.clearance,
                  "Take nothing that is less high above the table, metres: for a turntable")
      ->check(CLI::Range(0.0, 0.2).description(""))
      ->type_name("M");
  app->add_option("--at", options->at,
                  "A pixel of the object in the first picture; left out: what stands in the middle")
      ->expected(2)
      ->type_name("U V");
  app->add_option("--ply", options->ply,
                  "Also write the captured surface as a mesh, to be edited and built again")
      ->type_name("P.ply");
  app->add_option("--sensor", options->sensor,
                  "Sensor description (TOML): mode, camera and noise of a device")
      ->type_name("FILE");
  app->add_option("--poses", options->poses,
                  "Known poses of the object, camera <- object, as lines '<seconds> tx ty tz qx qy qz qw' "
                  "with the frames' "
                  "stamps; left out: found by alignment")
      ->type_name("FILE");
  app->add_option("--frames", options->frames, "Take this many frames from the source")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 62).description(""))
      ->type_name("N");
  app->callback([options, &work] { work = [options] { return capture(*options); }; });
}

}  // namespace pliant

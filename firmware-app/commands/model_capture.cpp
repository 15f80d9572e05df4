// pliant model capture: the sensor itself makes the model, of an object that is turned before it, or around
// which it is carried; or single views from files do.
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "core/capture/object_capture.hpp"
#include "drivers/geometry_files/output_place.hpp"
#include "drivers/lcm/publisher.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/recording/pose_list.hpp"
#include "drivers/view_files/view_files.hpp"
#include "firmware-app/commands/capture_pictures.hpp"
#include "firmware-app/commands/captured_model.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/inputs.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/commands/option_checks.hpp"
#include "firmware-app/pipeline/memory_block.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant {

namespace {

constexpr double megabytes(std::uintmax_t bytes) {
  return static_cast<double>(bytes) / 1e6;
}

/// Of a model or a surface, the most that is written.
constexpr std::uintmax_t kLeastRoom = 4'000'000;

Result<OpenSource> open_input(const CaptureOptions& options, const SourceOptions& source_options) {
  if (!options.views.empty()) {
    OpenSource open;
    Result<std::unique_ptr<DepthSource>> views =
        open_view_files(options.views, {options.camera, options.units == "mm" ? 0.001 : 1});
    if (!views) return views.error();
    open.source = std::move(*views);
    return open;
  }
  if (options.source.empty())
    return Error{ErrorKind::bad_input,
                 "nothing to capture from: name a source (--source openni2:), or files of single views"};
  return open_source(options.source, source_options);
}

/// Why nothing was captured, and the exit code.
int report_nothing(const CaptureOptions& options, const Taken& taken, const ObjectCapture& object) {
  if (taken.last == SourceEvent::lost) return report({ErrorKind::device, taken.fault});
  if (StopSignal::requested()) {
    print_warning("ended before anything was captured");
    return kExitNotFound;
  }
  if (!options.known.empty() && taken.bad_frames > 0 && object.figures().frames == 0)
    return report({ErrorKind::bad_input, options.poses + ": no pose has the time of a frame"});
  if (options.views.empty() && object.figures().frames == 0)
    return report({ErrorKind::bad_input,
                   taken.fault.empty() ? "the source has no frame" : "no frame is usable: " + taken.fault});
  print_warning("nothing was captured: in no picture did an object stand before the background");
  return kExitNotFound;
}

/// Checks the words that hang together; empty when all is well.
std::string refused_words(const CaptureOptions& options) {
  if (!options.views.empty() && !options.source.empty())
    return "--source and files of views exclude each other";
  if (!options.camera.empty() && options.views.empty()) return "--camera is for files of single views";
  if (options.frames >= 0 && !options.views.empty())
    return "--frames is for a source; of files, name as many as are wanted";
  if (options.views.size() > kMaxKeyframes)
    return fmt::format("{} views are too many, {} at most; make a recording of them (--source recording:DIR)",
                       options.views.size(), kMaxKeyframes);
  return "";
}

Outcome files_apart(const CaptureOptions& options) {
  NamedFiles files;
  files.reads_source("--source", options.source)
      .reads("--camera", options.camera)
      .reads("--sensor", options.sensor)
      .reads("--poses", options.poses)
      .writes("--output", options.output)
      .writes("--ply", options.ply)
      .uses_log("--lcm-url", options.lcm_url);
  for (const std::string& view : options.views) files.reads("VIEWS", view);
  return files.apart();
}

int capture(const CaptureOptions& given) {
  const StopSignal stop;
  CaptureOptions options = given;
  if (const std::string fault = refused_words(options); !fault.empty())
    return report({ErrorKind::bad_input, fault});
  if (const Outcome apart = files_apart(options); !apart) return report(apart.error());
  if (options.lcm_url != "none")
    if (const Outcome url = LcmPublisher::check_url(options.lcm_url); !url) return report(url.error());
  // A place that cannot be written to shows before the object was turned for half a minute, not after.
  for (const std::string& file : {options.output, options.ply}) {
    if (file.empty()) continue;
    if (const Outcome possible = check_output_place(file, kLeastRoom); !possible)
      return report(possible.error());
  }
  options.capture.separate_views = !options.views.empty();
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
    const Result<SensorFile> read = read_sensor(options.sensor);
    if (!read) return report(read.error());
    source_options.sensor = *read;
  }
  Result<OpenSource> source = open_input(options, source_options);
  if (!source) return report(source.error());
  const Intrinsics& camera = source->source->intrinsics();
  const SensorDescription sensor = sensor_of(*source->source, source_options);
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

  const bool to_be_placed = !options.views.empty() && options.known.empty();
  const Result<Taken> taken = to_be_placed ? take_views(*source->source, options, sensor, object)
                                           : take_pictures(*source->source, options, object);
  source->source->close();
  if (!taken) return report(taken.error());
  if (object.figures().fused == 0) return report_nothing(options, *taken, object);
  LiveLine line;
  line.show("closing the drift and fusing the views");
  const JointFit joint = object.finish();
  line.clear();
  const int code = write_captured_model(
      {options.output, options.ply, options.capture.clearance, usual_noise(sensor), options.material}, object,
      joint);
  if (code == kExitDone && taken->log_failed) return kExitFailed;
  if (code == kExitDone && taken->last == SourceEvent::lost) return report({ErrorKind::device, taken->fault});
  return code;
}

}  // namespace

void add_model_capture(CLI::App& model, Work& work) {
  CLI::App* app =
      model.add_subcommand("capture", "Make a model file with the sensor: turn the object before it");
  auto options = std::make_shared<CaptureOptions>();
  app->add_option("--source", options->source, kSourceHelp)->type_name("URI");
  app->add_option("VIEWS", options->views,
                  "Instead of a source: files of single views, depth pictures (16-bit PNG) or clouds (PLY, "
                  "PCD) in the frame of their camera; where they lie to each other is found, or given by "
                  "--poses");
  app->add_option("--camera", options->camera, "camera.toml of the depth pictures")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--units", options->units, "Unit of the clouds' coordinates")
      ->check(CLI::IsMember({"m", "mm"}).description(""))
      ->type_name("m|mm")
      ->capture_default_str();
  app->add_option("-o,--output", options->output, "Model file to write")
      ->required()
      ->check(names_a_file())
      ->type_name("OUT.model");
  app->add_option("--size", options->capture.size, "Edge of the cube that holds the object, metres")
      ->check(number_within(0.05, 1))
      ->type_name("M")
      ->capture_default_str();
  app->add_option("--voxel", options->capture.voxel,
                  "Edge of a voxel, metres; left out: what the sensor's noise allows to tell apart")
      ->check(number_within(0.0005, 0.02))
      ->type_name("M");
  app->add_option("--clearance", options->capture.clearance,
                  "Take nothing that is less high above the table, metres: for a turntable")
      ->check(number_within(0, 0.2))
      ->type_name("M");
  app->add_option("--material", options->material, "How easily the object stretches, 0 stiff to 1 soft")
      ->check(number_within(0, 1))
      ->type_name("0..1")
      ->capture_default_str();
  app->add_option("--at", options->at,
                  "A pixel of the object in the first picture; left out: what stands in the middle")
      ->expected(2)
      ->check(whole_from_zero())
      ->type_name("U V");
  app->add_option("--ply", options->ply,
                  "Also write the captured surface as a mesh, to be edited and built again")
      ->check(names_a_file())
      ->type_name("P.ply");
  app->add_option("--sensor", options->sensor,
                  "Sensor description (TOML): mode, camera and noise of a device, noise of any other source")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--poses", options->poses,
                  "Known poses of the object, camera <- object, as lines '<seconds> tx ty tz qx qy qz qw' "
                  "with the frames' stamps (of files: their position, from 0); left out: found by alignment")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--lcm-url", options->lcm_url,
                  "LCM network on which 'pliant view' sees the model grow, 'none' to publish nothing")
      ->type_name("URL");
  app->add_option("--frames", options->frames, "Take this many frames from the source")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 62).description(""))
      ->type_name("N");
  app->callback([options, &work] { work = [options] { return capture(*options); }; });
}

}  // namespace pliant

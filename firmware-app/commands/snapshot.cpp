// pliant snapshot: what is published right now, or was when a log was written, as a picture.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "drivers/images/png.hpp"
#include "drivers/lcm/subscriber.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/named_files.hpp"
#include "firmware-app/commands/option_checks.hpp"
#include "firmware-app/export/log_exporter.hpp"
#include "firmware-app/measure/clock.hpp"
#include "firmware-app/outputs/words.hpp"
#include "firmware-app/pictures/scene_picture.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant {

namespace {

struct SnapshotOptions {
  std::string output, url, prefix = "PLIANT", log;
  std::int64_t frame = -1;
  double wait = 10;
};

/// What a picture is made of.
struct Seen {
  ReceivedFrame frame;
  bool have_frame = false, have_status = false, have_depth = false;
  std::vector<Point3f> positions;
  float spacing = 0;
  StatusMessage status;
  ReceivedDepth depth;

  void take(const ReceivedFrame& newer, const ReceivedModel& model) {
    frame = newer;
    have_frame = true;
    spacing = model.spacing;
    place_points(frame, model, positions);
  }
};

std::vector<float> displacements(const Seen& seen) {
  std::vector<float> lengths(seen.positions.size());
  for (std::size_t i = 0; i < seen.frame.deformed.size(); ++i) {
    const auto index = static_cast<std::size_t>(seen.frame.deformed[i]);
    const Point3f& d = seen.frame.displacement[i];
    if (index < lengths.size()) lengths[index] = std::hypot(d.x, d.y, d.z);
  }
  return lengths;
}

int draw(const Seen& seen, const std::string& output) {
  SceneView view;
  const bool depth = seen.have_depth && seen.depth.frame == seen.frame.frame;
  view.camera = depth ? seen.depth.camera : camera_that_shows(seen.positions, 640, 480);
  if (depth) view.depth = seen.depth.depth;
  view.title = fmt::format("frame {}: {}", seen.frame.frame, state_word(seen.frame.state));
  const std::vector<float> lengths = displacements(seen);
  std::vector<RigidTransform> axes;
  if (!seen.positions.empty()) {
    view.positions = seen.positions;
    view.labels = seen.frame.labels;
    view.displacement = lengths;
    view.spacing = static_cast<double>(seen.spacing);
    for (const RegionMessage& r : seen.frame.regions)
      axes.push_back({rotation_from_quaternion({r.quat[0], r.quat[1], r.quat[2], r.quat[3]}),
                      Vector3(r.trans[0], r.trans[1], r.trans[2])});
    view.axes = axes;
  }
  if (seen.have_status)
    view.notes.push_back(fmt::format("{:.1f} frames/s, latency {:.1f} ms, device {}", seen.status.rate,
                                     seen.status.latency_median / 1000.0, name_of(seen.status.device)));
  const Canvas canvas = draw_scene(view);
  if (const Outcome written = write_png_rgb8(output, canvas.width(), canvas.height(), canvas.rgb()); !written)
    return report(written.error());
  return print(fmt::format("{}: {}\n", output, view.title)) ? kExitDone : kExitFailed;
}

/// Keeps the frame wanted, or the last tracked one.
class FrameOfLog final : public LogExporter {
 public:
  FrameOfLog(std::int64_t wanted, Seen& seen) : wanted_(wanted), seen_(seen) {}
  Outcome frame(std::int64_t /*received_us*/, const ReceivedFrame& frame, const ReceivedModel* model,
                std::span<const Point3f> /*positions*/) override {
    const bool take =
        wanted_ >= 0 ? frame.frame == wanted_ : model != nullptr || seen_.frame.state != TrackState::tracking;
    if (take) seen_.take(frame, model != nullptr ? *model : ReceivedModel{});
    return success();
  }
  Outcome depth(std::int64_t /*received_us*/, const ReceivedDepth& depth) override {
    // A picture follows its frame.
    if (!seen_.have_frame || seen_.frame.frame != depth.frame) return success();
    seen_.depth = depth;
    seen_.have_depth = true;
    return success();
  }
  Outcome status(std::int64_t /*received_us*/, const StatusMessage& status) override {
    seen_.status = status;
    seen_.have_status = true;
    return success();
  }
  Outcome finish() override { return success(); }
  [[nodiscard]] std::string summary() const override { return {}; }

 private:
  std::int64_t wanted_;
  Seen& seen_;
};

Outcome look_in_log(const SnapshotOptions& options, Seen& seen) {
  const Result<std::vector<ReceivedModel>> models = models_in_log(options.log, options.prefix);
  if (!models) return models.error();
  FrameOfLog taker(options.frame, seen);
  LogExporter* const exporters[] = {&taker};
  const Result<LogFigures> walked = walk_log(options.log, options.prefix, *models, exporters);
  if (!walked) return walked.error();
  if (seen.have_frame) return success();
  return Error{ErrorKind::bad_input,
               options.frame < 0 ? fmt::format("'{}' holds no whole frame", options.log)
                                 : fmt::format("'{}' holds no whole frame {}", options.log, options.frame)};
}

Outcome look_at_bus(const SnapshotOptions& options, Seen& seen) {
  const StopSignal stop;
  FrameAssembler frames;
  ModelAssembler models;
  PictureAssembler depths;
  ReceivedFrame newest;
  bool any = false, fresh = false;
  LcmSubscriber::Handlers handlers;
  const auto take = [&](bool whole) {
    any = any || whole;
    fresh = fresh || whole;
    if (whole) newest = frames.frame();
  };
  handlers.regions = [&](const RegionsMessage& message) { take(frames.take(message)); };
  handlers.deformed = [&](const DeformedMessage& message) { take(frames.take(message)); };
  handlers.model = [&](const ModelMessage& message) { static_cast<void>(models.take(message)); };
  handlers.status = [&](const StatusMessage& message) {
    seen.status = message;
    seen.have_status = true;
  };
  handlers.depth = [&](const DepthMessage& message) {
    if (!depths.take(message)) return;
    seen.depth = depths.picture();
    seen.have_depth = true;
  };
  Result<std::unique_ptr<LcmSubscriber>> subscriber =
      LcmSubscriber::create(options.url, options.prefix, std::move(handlers));
  if (!subscriber) return subscriber.error();

  const std::int64_t begin = monotonic_ns();
  const auto seconds = [&] { return static_cast<double>(monotonic_ns() - begin) * 1e-9; };
  double tracked_since = -1;
  while (seconds() < options.wait && !StopSignal::requested()) {
    if ((*subscriber)->handle(50) < 0) break;
    const bool placed = newest.state == TrackState::tracking && newest.model_id == models.model().model_id;
    if (!any || !placed || !fresh) continue;
    if (tracked_since < 0) tracked_since = seconds();
    // A picture of the very frame is waited for where pictures are published, a second long.
    if (seen.have_depth ? seen.depth.frame == newest.frame : seconds() - tracked_since > 1) break;
    fresh = false;
  }
  if (!any)
    return Error{
        ErrorKind::bad_input,
        fmt::format("nothing is published on {}_* within {:g} s; start a tracker ('pliant run'), or name its "
                    "--lcm-url and --prefix",
                    options.prefix, options.wait)};
  seen.take(newest, models.model());
  return success();
}

int snapshot(const SnapshotOptions& options) {
  const Outcome apart = NamedFiles()
                            .reads("--log", options.log)
                            .uses_log("--lcm-url", options.url)
                            .writes("--output", options.output)
                            .apart();
  if (!apart) return report(apart.error());
  Seen seen;
  const Outcome looked = options.log.empty() ? look_at_bus(options, seen) : look_in_log(options, seen);
  return looked ? draw(seen, options.output) : report(looked.error());
}

}  // namespace

void add_snapshot(CLI::App& program, Work& work) {
  CLI::App* app = program.add_subcommand("snapshot", "Draw what a tracker publishes, without a display");
  auto options = std::make_shared<SnapshotOptions>();
  app->add_option("-o,--output", options->output, "PNG file to write")
      ->required()
      ->check(names_a_file())
      ->type_name("P.png");
  app->add_option("--lcm-url", options->url, "LCM network to listen on")->type_name("URL");
  app->add_option("--prefix", options->prefix, "First word of the channels' names")
      ->capture_default_str()
      ->type_name("PREFIX");
  app->add_option("--wait", options->wait, "Seconds to wait for a tracked frame")
      ->check(number_within(0.1, 3600))
      ->capture_default_str()
      ->type_name("S");
  CLI::Option* log = app->add_option("--log", options->log, "A log of lcm-logger instead of the network")
                         ->check(names_a_file())
                         ->type_name("FILE");
  app->add_option("--frame", options->frame, "The log's frame; left out: the last one tracked")
      ->check(CLI::NonNegativeNumber.description(""))
      ->needs(log)
      ->type_name("N");
  app->callback([options, &work] { work = [options] { return snapshot(*options); }; });
}

}  // namespace pliant

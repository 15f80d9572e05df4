// pliant run: the tracker.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "core/simd/cpu.hpp"
#include "drivers/geometry_files/atomic_file.hpp"
#include "firmware-app/commands/commands.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/option_checks.hpp"
#include "firmware-app/commands/run_inputs.hpp"
#include "firmware-app/measure/clock.hpp"
#include "firmware-app/outputs/run_report.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"
#include "firmware-app/pipeline/worker.hpp"
#include "firmware-app/service/reload_signal.hpp"
#include "firmware-app/service/service_link.hpp"

namespace pliant {

namespace {

const std::map<std::string, Kernels> kKernelNames = {{"auto", Kernels::automatic},
                                                     {"scalar", Kernels::scalar},
                                                     {"sse", Kernels::sse},
                                                     {"avx2", Kernels::avx2},
                                                     {"neon", Kernels::neon}};

constexpr int kCloseMs = 300;

/// -1 where unknown.
std::int64_t frames_to_come(std::int64_t in_source, std::int64_t limit) {
  if (in_source < 0 || limit < 0) return std::max(in_source, limit);
  return std::min(in_source, limit);
}

/// All kernels give the same bytes, so one that this processor has not is no error.
void warn_of_missing_kernels(Kernels kernels) {
  if (kernels != Kernels::automatic && kernels != Kernels::scalar && simd_body(kernels) == SimdBody::scalar)
    print_warning("this processor has not the kernels asked for; the scalar ones run");
}

int finish(const RunOptions& options, const RunEnd& end, AtomicFile& stats) {
  const RunFigures& figures = end.figures;
  bool failed = end.files_failed || end.log_failed;
  if (!options.stats.empty()) {
    const std::string json = stats_json(figures);
    Outcome written = stats.write(std::as_bytes(std::span(json)));
    if (written) written = stats.commit(false);
    if (!written) {
      static_cast<void>(report(written.error()));
      failed = true;
    }
  }
  if (!print(closing_table(figures))) failed = true;
  if (end.device_lost) return report({ErrorKind::device, end.fault});
  if (failed) return kExitFailed;
  if (end.stopped) return kExitDone;
  if (figures.frames() == 0)
    return report({ErrorKind::bad_input,
                   end.fault.empty() ? "the source has no frame" : "no frame is usable: " + end.fault});
  return figures.last_state == TrackState::tracking ? kExitDone : kExitNotFound;
}

/// What a person, and the service manager, read while a run goes on.
class Watcher {
 public:
  Watcher() : link_(ServiceLink::from_environment(warning_)) {
    if (!warning_.empty()) print_warning(warning_);
  }

  void warn(const std::string& message) {
    line_.clear();
    print_warning(message);
  }
  void look(const LiveFigures& live, std::int64_t frame_count) {
    if (line_.active()) line_.show(status_line(live, frame_count));
    tell_of_overload(live);
    if (!link_.active()) return;
    const std::int64_t now = monotonic_ns();
    link_.update({live.captured.load(), live.begun.load(), live.finished.load()}, now);
    link_.tell(status_line(live, frame_count), now);
  }
  void reloading() { link_.reloading(monotonic_ns()); }
  void stopping(const RunFigures& figures) {
    line_.clear();
    link_.stopping(fmt::format("ended after {} frames, {} tracked", figures.frames(), figures.tracked));
  }

 private:
  /// Once when work is shed for longer than a passing moment, and again only after all of it was done.
  void tell_of_overload(const LiveFigures& live) {
    const double level = live.work_level.load();
    const std::int64_t now = monotonic_ns();
    if (level >= kShedding) {
      shedding_since_ns_ = now;
      if (level >= 1) overloaded_ = false;
      return;
    }
    if (overloaded_ || now - shedding_since_ns_ < kPassingNs) return;
    overloaded_ = true;
    warn(fmt::format(
        "frames take longer than track.budget_ms: fewer points and iterations are used, work level "
        "{:.2f}",
        level));
  }

  static constexpr double kShedding = 0.9;
  static constexpr std::int64_t kPassingNs = 3'000'000'000;
  std::string warning_;
  LiveLine line_;
  ServiceLink link_;
  bool overloaded_ = false;
  std::int64_t shedding_since_ns_ = monotonic_ns();
};

/// Whether the same description says something else now.
bool is_described_anew(const RunInputs& before, const RunInputs& after) {
  return before.config.sensor.description == after.config.sensor.description && before.sensor &&
         after.sensor && !before.sensor->says_the_same_as(*after.sensor);
}

/// The config as it is now, opened; an error keeps the old one.
Result<RunInputs> reload(const RunOptions& options, const RunInputs& current) {
  const Result<Config> config = merged_config(options);
  if (!config) return config.error();
  if (options.writes_files() && !changed_keys(current.config, *config).empty())
    return Error{ErrorKind::bad_input, "a run that writes files keeps its config"};
  Result<RunInputs> read = open_run_inputs(options, *config, &current);
  if (!read || !options.writes_files()) return read;
  if (read->model != current.model)
    return Error{ErrorKind::bad_input,
                 "a run that writes files keeps its model, and the model file is another"};
  if (is_described_anew(current, *read))
    return Error{ErrorKind::bad_input,
                 "a run that writes files keeps its sensor description, and that says something else now"};
  return read;
}

/// What a reload brings, for people; empty when it brings nothing.
std::string news_of(const RunInputs& before, const RunInputs& after) {
  std::string news = changed_keys(before.config, after.config);
  const auto add = [&news](const char* what) { news.append(news.empty() ? "" : ", and ").append(what); };
  if (before.config.model == after.config.model && before.model != after.model)
    add("the model file is another");
  if (is_described_anew(before, after)) add("the sensor description is another");
  return news;
}

/// A device or a file system that hangs must not hold the program's end up.
bool close_in_time(DepthSource& source) {
  auto closer = std::make_unique<Worker>();
  std::string ignored;
  if (!closer->start(
          {.name = "pliant-close", .priority = 0, .affinity = {}}, [&source] { source.close(); }, ignored))
    return false;
  if (closer->join_within(kCloseMs)) return true;
  static_cast<void>(closer.release());  // still used by its thread
  return false;
}

int run(const RunOptions& options) {
  const StopSignal stop;
  std::optional<ReloadSignal> reload_signal;
  if (!options.config.empty()) reload_signal.emplace();
  const Result<Config> config = merged_config(options);
  if (!config) return report(config.error());
  Result<RunInputs> opened = open_run_inputs(options, *config, nullptr);
  if (!opened) return report(opened.error());
  RunInputs inputs = std::move(*opened);
  warn_of_missing_kernels(options.kernels);

  // Opened before the run, so that a run of hours does not end without its figures.
  AtomicFile stats;
  if (!options.stats.empty())
    if (Outcome opened_stats = stats.open(options.stats.c_str()); !opened_stats)
      return report(opened_stats.error());

  Watcher watcher;
  std::optional<RunInputs> next, before;
  std::optional<RigidTransform> pose;
  std::set<std::string> logs;  // that this run has written: a reload must not empty them
  std::int64_t taken = 0;
  for (;;) {
    RunSettings settings = inputs.settings;
    settings.start_pose = pose;
    settings.add_to_log = !logs.insert(settings.lcm_url).second;
    if (options.frames >= 0) settings.frame_limit = options.frames - taken;
    const std::int64_t frame_count = frames_to_come(inputs.source->source->frame_count(), options.frames);
    settings.warn = [&](const std::string& message) { watcher.warn(message); };
    settings.progress = [&](const LiveFigures& live) { watcher.look(live, frame_count); };
    settings.leave = [&] {
      if (!ReloadSignal::take()) return false;
      watcher.reloading();
      Result<RunInputs> read = reload(options, inputs);
      if (!read) {
        watcher.warn("the old config stays: " + read.error().message);
        return false;
      }
      const std::string news = news_of(inputs, *read);
      watcher.warn(news.empty() ? "config read again: nothing has changed" : "config read again: " + news);
      if (news.empty()) return false;
      next = std::move(*read);
      return true;
    };

    const Result<RunEnd> end = run_pipeline(*inputs.source->source, inputs.model->view(), settings);
    if (!end) {
      if (!before) return report(end.error());
      watcher.warn("the old config comes back: " + end.error().message);
      inputs = std::move(*before);
      before.reset();
      continue;
    }
    taken += end->taken;
    if (end->left && end->source_hangs) {
      // It cannot be used again, nor closed; a service manager starts the program anew.
      static_cast<void>(report({ErrorKind::device, "the device does not answer: it cannot be taken over"}));
      std::fflush(nullptr);
      std::_Exit(kExitFailed);
    }
    if (end->left && next && (options.frames < 0 || taken < options.frames)) {
      const bool same_object = next->model == inputs.model && next->source == inputs.source;
      pose.reset();
      if (same_object && end->figures.last_state == TrackState::tracking) pose = end->figures.last_pose;
      before = std::exchange(inputs, std::move(*next));
      next.reset();
      continue;
    }
    watcher.stopping(end->figures);
    const int code = finish(options, *end, stats);
    if (!end->source_hangs && close_in_time(*inputs.source->source)) return code;
    // Only a device notices.
    if (inputs.source->source->live()) print_warning("the device does not answer: ended without closing it");
    std::fflush(nullptr);
    std::_Exit(code);
  }
}

}  // namespace

void add_run(CLI::App& program, Work& work) {
  CLI::App* app = program.add_subcommand("run", "Track a model in the frames of a source");
  auto options = std::make_shared<RunOptions>();
  app->add_option("--config", options->config, "Config file (TOML); the options below win over it")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--model", options->model, "Model file; a simulated source brings its own")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--source", options->source, kSourceHelp)->type_name("URI");
  app->add_option("--sensor", options->sensor,
                  "Sensor description (TOML): mode, camera and noise of a device, noise of any other source")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_flag("--publish-depth", options->publish_depth, "Publish the depth frames too");
  app->add_option("--trajectory", options->trajectory, "Write the base region's path, TUM format")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--points", options->points, "Write where every point is, a PLY file per tracked frame")
      ->check(names_a_folder())
      ->type_name("DIR");
  app->add_option("--stats", options->stats, "Write the run's figures, JSON")
      ->check(names_a_file())
      ->type_name("FILE");
  app->add_option("--lcm-url", options->lcm_url, "LCM network to publish on, 'none' to publish nothing")
      ->type_name("URL");
  app->add_option("--frames", options->frames, "Take this many frames from the source")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 62).description(""))
      ->type_name("N");
  app->add_option("--pace", options->pace,
                  "realtime: frames come when their stamps say, the newest wins; fast: every frame, as fast "
                  "as can be. Files are fast by default, live sources have their own pace")
      ->check(CLI::IsMember({"realtime", "fast"}).description(""))
      ->type_name("realtime|fast");
  app->add_option("--threads", options->threads, "Threads that share the work of one frame, 1 to 64")
      ->check(CLI::Range(1, 64).description(""))
      ->type_name("N");
  app->add_option("--kernels", options->kernels, "Instruction set of the kernels; all give the same bytes")
      ->transform(CLI::CheckedTransformer(kKernelNames).description(""))
      ->type_name("auto|scalar|sse|avx2|neon");
  app->callback([options, &work] { work = [options] { return run(*options); }; });
}

}  // namespace pliant

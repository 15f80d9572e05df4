// The demonstration behind ./dev demo: the tracker on the built-in simulated sensor, in real time, with a
// subscriber that checks what is published, pictures, and the error against the simulator's truth.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>

#include "drivers/lcm/lcm_url.hpp"
#include "drivers/lcm/multicast_probe.hpp"
#include "firmware-app/commands/console.hpp"
#include "firmware-app/commands/inputs.hpp"
#include "firmware-app/demo/listener.hpp"
#include "firmware-app/demo/private_network.hpp"
#include "firmware-app/demo/snapshots.hpp"
#include "firmware-app/demo/truth_check.hpp"
#include "firmware-app/measure/clock.hpp"
#include "firmware-app/outputs/run_report.hpp"
#include "firmware-app/pipeline/run_pipeline.hpp"
#include "firmware-app/pipeline/stop_signal.hpp"

namespace pliant::demo {

namespace {

constexpr const char* kPrefix = "PLIANT";

struct Options {
  std::string output = "out/demo";
  std::string source = "simulated:cushion";
  int seconds = 10;
};

/// How messages travel from the tracker to the subscriber.
struct Way {
  std::string url;
  std::string words;
  bool live = true;  ///< false: through a log file that is read afterwards
};

/// The best way that this machine allows.
Way find_way(const Options& options) {
  const std::string fault = enter_private_network();
  const std::string url(kDefaultLcmUrl);
  const Result<LcmUrl> parsed = LcmUrl::parse(url);
  if (parsed && multicast_route_fault(*parsed) == nullptr && multicast_comes_back(*parsed))
    return {url,
            fault.empty() ? "LCM multicast in a network of the demo's own" : "LCM multicast on this host",
            true};
  print_warning(fmt::format("no multicast here ({}); messages go into a log file and are read back from it",
                            fault.empty() ? "it does not come back" : fault));
  return {fmt::format("file://{}/messages.lcmlog?mode=w", options.output), "an LCM log file", false};
}

/// A picture every few seconds: before, during and after each press.
std::vector<std::int64_t> picture_frames(std::int64_t frames) {
  std::vector<std::int64_t> wanted;
  for (const std::int64_t frame : {5, 60, 110, 160, 230, 290})
    if (frame < frames) wanted.push_back(frame);
  return wanted;
}

/// The live line; where nobody watches a terminal, a line every two seconds.
class Progress {
 public:
  explicit Progress(std::int64_t frames) : frames_(frames) {}
  void operator()(const LiveFigures& live) {
    const std::string text = status_line(live, frames_);
    if (line_.active()) {
      line_.show(text);
    } else if (monotonic_ns() - last_ns_ > 2'000'000'000) {
      static_cast<void>(print(text + "\n"));
      last_ns_ = monotonic_ns();
    }
  }
  void clear() { line_.clear(); }

 private:
  std::int64_t frames_;
  LiveLine line_;
  std::int64_t last_ns_ = monotonic_ns();
};

std::string truth_rows(const TruthCheck& check) {
  const auto thousandths = [](const Histogram& h, double q) {
    return static_cast<double>(h.quantile(q)) * 1e-3;
  };
  return fmt::format(
      "position   {:>6.2f}  mm median error of the observed points, 95 % within {:.2f} mm\n"
      "base pose  {:>6.2f}  mm and {:.2f} degrees median error\n",
      thousandths(check.position(), 0.5), thousandths(check.position(), 0.95),
      thousandths(check.base_shift(), 0.5), thousandths(check.base_angle(), 0.5));
}

std::string message_row(const LcmSubscriber::Counters& got, std::int64_t frames, const Way& way) {
  return fmt::format(
      "received   {:>6}  messages decoded: {} pose, {} regions ({} frames), {} deformed, {} status; {} "
      "garbled\n"
      "           over {}\n",
      got.total(), got.of(MessageKind::pose), got.of(MessageKind::regions), frames,
      got.of(MessageKind::deformed), got.of(MessageKind::status), got.garbage, way.words);
}

int run(const Options& options) {
  std::error_code fault;
  std::filesystem::create_directories(options.output, fault);
  if (fault)
    return report(
        {ErrorKind::write, fmt::format("cannot make the folder {}: {}", options.output, fault.message())});
  const Way way = find_way(options);
  const StopSignal stop;

  const std::int64_t frames = 30 * std::int64_t{options.seconds};
  Result<std::unique_ptr<SimulatedSource>> simulated =
      open_simulated(fmt::format("{}?frames={}", options.source, frames));
  if (!simulated) return report(simulated.error());
  RememberingSource source(std::move(*simulated));
  Result<ModelFile> model = load_model("", options.source);
  if (!model) return report(model.error());
  static_cast<void>(
      print(fmt::format("model: {} points; source: {}, {} frames of {}x{}\n", model->view().size(),
                        options.source, frames, source.intrinsics().width, source.intrinsics().height)));

  Snapshots snapshots(source.intrinsics(), model->view(), picture_frames(frames));
  TruthCheck check(model->view(), source);
  struct Witnesses {
    Snapshots& snapshots;
    TruthCheck& check;
  } witnesses{snapshots, check};

  std::unique_ptr<Listener> listener;
  if (way.live) {
    Result<std::unique_ptr<Listener>> made = Listener::create(way.url, kPrefix);
    if (!made) return report(made.error());
    listener = std::move(*made);
  }

  Progress progress(frames);
  RunSettings settings;
  settings.source_name = options.source;
  settings.version = PLIANT_VERSION;
  settings.sensor = source.sensor();
  settings.lcm_url = way.url;
  settings.lcm_prefix = kPrefix;
  settings.realtime = true;
  settings.progress = [&](const LiveFigures& live) { progress(live); };
  settings.warn = [&](const std::string& line) {
    progress.clear();
    print_warning(line);
  };
  settings.witness = {[](void* context, const DepthFrame& frame, const TrackResult& result) {
                        auto* seen = static_cast<Witnesses*>(context);
                        seen->snapshots.look(frame, result);
                        seen->check.look(result);
                      },
                      &witnesses};
  const Result<RunEnd> end = run_pipeline(source, model->view(), settings);
  progress.clear();
  if (!end) return report(end.error());

  if (!way.live) {
    Result<std::unique_ptr<Listener>> made =
        Listener::create(fmt::format("file://{}/messages.lcmlog?speed=0", options.output), kPrefix);
    if (!made) return report(made.error());
    listener = std::move(*made);
  }
  const LcmSubscriber::Counters got = listener->finish();
  const Result<int> pictures = snapshots.write(options.output);
  if (!pictures) return report(pictures.error());

  std::string table = "\n" + closing_table(end->figures);
  if (check.position().count() > 0) table += truth_rows(check);
  table += message_row(got, listener->frames(), way);
  table += fmt::format("pictures   {:>6}  in {}\n", *pictures, options.output);
  if (!print(table)) return kExitFailed;

  if (got.of(MessageKind::regions) == 0 || got.garbage > 0)
    return report({ErrorKind::device, "the messages did not arrive whole"});
  if (end->stopped) return kExitDone;
  return end->figures.last_state == TrackState::tracking ? kExitDone : kExitNotFound;
}

}  // namespace

}  // namespace pliant::demo

int main(int count, char** words) {
  pliant::demo::Options options;
  CLI::App app("Tracks a simulated object in real time and checks everything that comes out.", "pliant_demo");
  app.add_option("-o,--output", options.output, "Folder of the pictures")->capture_default_str();
  app.add_option("--source", options.source, "simulated:cushion|figure|box")->capture_default_str();
  app.add_option("--seconds", options.seconds, "How long")->check(CLI::Range(1, 3600))->capture_default_str();
  try {
    app.parse(count, words);
    return pliant::demo::run(options);
  } catch (const CLI::ParseError& fault) {
    return app.exit(fault) == 0 ? pliant::kExitDone : pliant::kExitBadInput;
  } catch (const std::exception& fault) {
    return pliant::report({pliant::ErrorKind::device, fmt::format("internal error: {}", fault.what())});
  }
}

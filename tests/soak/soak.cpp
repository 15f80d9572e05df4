// soak FRAMES: a whole run, capture to network, over so many frames of a faulty device, with a slow
// subscriber and a busy neighbour. Fails when a frame is not accounted for, when the path of a frame called
// the heap or faulted a page, when the process grew, when a deadline was missed and not counted, or when the
// object was not followed.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/model_file.hpp"
#include "drivers/simulated/simulated.hpp"
#include "firmware-app/measure/path_cost.hpp"
#include "firmware-app/pipeline/run_pipeline.hpp"
#include "tests/lcm/network_namespace.hpp"
#include "tests/soak/faulty_source.hpp"
#include "tests/soak/neighbours.hpp"

namespace pliant::soak {

namespace {

constexpr const char* kScene = "simulated:cushion?width=160&height=120&frames=120";
constexpr double kSpacing = 0.012;  // metres: a coarse model, so that 100,000 frames take minutes
constexpr double kBudgetMs = 5;
constexpr std::uint64_t kPage = 4096;
constexpr std::uint64_t kMovedPages = 10;  // the kernel moves a page now and then, which faults it once

int fail(const std::string& what) {
  fmt::print(stderr, "soak: {}\n", what);
  return 2;
}

/// Resident memory once the run is warm.
struct Growth {
  std::int64_t warm_after = 0, seen = 0;
  std::uint64_t least = UINT64_MAX, most = 0;
  std::atomic<std::int64_t> told{0};

  void look() {
    told.store(++seen, std::memory_order_release);
    if (seen < warm_after || seen % 256 != 0) return;
    const std::uint64_t bytes = resident_bytes();
    least = std::min(least, bytes);
    most = std::max(most, bytes);
  }
};

/// How many values of a histogram lie clearly above `limit`; right to the histogram's 2 %.
std::int64_t count_above(const Histogram& histogram, std::int64_t limit) {
  std::int64_t low = 0, high = static_cast<std::int64_t>(histogram.count());
  while (low < high) {  // the most values that are all below
    const std::int64_t middle = (low + high + 1) / 2;
    const double share = static_cast<double>(middle) / static_cast<double>(histogram.count());
    (histogram.quantile(share) <= limit ? low : high) =
        histogram.quantile(share) <= limit ? middle : middle - 1;
  }
  return static_cast<std::int64_t>(histogram.count()) - low;
}

bool holds(bool condition, const std::string& what) {
  fmt::print("  {:<5} {}\n", condition ? "ok" : "FAILS", what);
  return condition;
}

int soak(std::int64_t frames) {
  const char* const no_network = enter_network_namespace();
  if (no_network != nullptr) fmt::print("{}: nothing is published\n", no_network);
  const pid_t subscriber = start_neighbour(kSlowSubscriber), neighbour = start_neighbour(kBusy);
  const Result<std::unique_ptr<SimulatedSource>> simulated = open_simulated(kScene);
  if (!simulated) return fail(simulated.error().message);
  ModelBuildSettings model_settings;
  model_settings.spacing = kSpacing;
  Result<BuiltModel> built = build_model((*simulated)->mesh(), model_settings);
  if (!built) return fail(built.error().message);
  const Result<ModelFile> model = ModelFile::from_image(std::move(built->image), kScene);
  if (!model) return fail(model.error().message);
  Intrinsics camera;
  auto pictures = FaultySource::draw(kScene, 120, camera);
  if (!pictures) return fail(pictures.error().message);

  Growth growth;
  growth.warm_after = std::min<std::int64_t>(frames / 10, 20'000);
  FaultySource source(std::move(*pictures), camera, frames, growth.told);
  RunSettings settings;
  settings.source_name = "soak";
  settings.version = "soak";
  settings.sensor = source.sensor();
  settings.lcm_url = no_network == nullptr ? "" : "none";
  settings.budget_ms = kBudgetMs;
  settings.witness = {[](void* self, const DepthFrame& /*frame*/, const TrackResult& /*result*/) {
                        static_cast<Growth*>(self)->look();
                      },
                      &growth};
  settings.warn = [](const std::string& line) { fmt::print(stderr, "soak: {}\n", line); };
  const Result<RunEnd> end = run_pipeline(source, model->view(), settings);
  end_neighbour(subscriber);
  end_neighbour(neighbour);
  if (!end) return fail(end.error().message);

  const RunFigures& f = end->figures;
  const auto budget_ns = static_cast<std::int64_t>(kBudgetMs * 1e6);
  const std::int64_t above = count_above(f.profile.total(), budget_ns + budget_ns / 50);
  fmt::print(
      "{} frames in {:.0f} s ({:.0f} a second): tracked {}, lost {}, searching {}, dropped {}, bad {}\n",
      source.given(), f.seconds, static_cast<double>(source.given()) / f.seconds, f.tracked, f.lost,
      f.searching, f.dropped, f.bad_frames);
  fmt::print("time of a tracked frame {:.2f} ms, p99 {:.2f}, most {:.2f}; work level down to {:.2f}\n",
             static_cast<double>(f.profile.total().median()) * 1e-6,
             static_cast<double>(f.profile.total().p99()) * 1e-6,
             static_cast<double>(f.profile.total().max()) * 1e-6, f.least_work_level);
  fmt::print("{} messages sent, {} frames unsent; {:.2f} MB resident\n", f.sent.messages, f.sent.unsent,
             static_cast<double>(growth.most) * 1e-6);
  bool well = holds(f.frames() + f.dropped + f.bad_frames == frames,
                    "every frame is tracked, lost, searched, dropped or bad");
  well &= holds(f.tracked > frames * 8 / 10, "the object is followed in four of five frames at least");
  well &= holds(f.heap_watched && f.heap_calls == 0,
                fmt::format("{} heap calls on the path of a frame", f.heap_calls));
  well &= holds(f.page_faults <= kMovedPages, fmt::format("{} page faults there", f.page_faults));
  well &=
      holds(growth.most > 0 && growth.most - growth.least <= kPage,
            fmt::format("resident memory within {} bytes after the first tenth", growth.most - growth.least));
  well &= holds(f.deadline_misses >= above,
                fmt::format("{} deadlines missed by tracked frames, {} counted", above, f.deadline_misses));
  well &= holds(f.deadline_misses <= above + f.tracked / 20 + f.lost + f.searching,
                "and none counted that was kept");
  if (no_network == nullptr)
    well &= holds(f.sent.messages > 0 && f.sent.messages >= 2 * (f.tracked - f.sent.unsent),
                  "what was not given up for newer frames was sent");
  return well ? 0 : 1;
}

}  // namespace

}  // namespace pliant::soak

int main(int count, char** words) {
  try {
    if (count == 2) pliant::soak::play_neighbour(words[1]);
    const long long frames = count == 2 ? std::atoll(words[1]) : 0;
    if (frames >= 1000) return pliant::soak::soak(frames);
    std::fputs("usage: soak FRAMES   (1000 at least)\n", stderr);
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "soak: %s\n", fault.what());
  }
  return 2;
}

// Follows a recording with one step of the method left out, or with all, for BENCHMARK.md:
//   follow_sequence RECORDING OUT [input_filter | temporal_evidence | merge_and_split | robust_weights]
// Writes points files of the tracked frames to OUT/warp, and, with all steps, of the same frames without the
// warp to OUT/rigid and OUT/radius. Prints one line of JSON: frames, tracked ones, how often a point changed
// its region, regions that came, and microseconds of processor time a tracked frame, median: all of it, and
// its three placings.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "core/tracker.hpp"
#include "drivers/geometry_files/points_ply.hpp"
#include "drivers/recording/recording.hpp"
#include "tests/accuracy/plain_placing.hpp"
#include "tests/accuracy/registration_runs.hpp"

namespace pliant {
namespace {

/// How far a deformed point is searched for: as far as the tracker's own warp looks.
constexpr double kRadius = 0.024;

double thread_us() {
  return 1e3 * thread_ms();
}

/// Processor time of the stages of one frame.
struct FrameClock {
  double last = 0, deform = 0;
  static void done(void* context, Stage stage) {
    auto& clock = *static_cast<FrameClock*>(context);
    const double now = thread_us();
    if (stage == Stage::deform) clock.deform += now - clock.last;
    clock.last = now;
  }
};

/// How regions come and points change them, from frame to frame.
struct Changes {
  std::vector<std::int8_t> before;
  std::array<bool, limits::kMaxRegions> alive{};
  std::int64_t of_points = 0, regions_came = 0;

  void look(const TrackResult& result) {
    for (std::size_t i = 0; i < before.size(); ++i)
      of_points += before[i] >= 0 && result.labels[i] >= 0 && before[i] != result.labels[i] ? 1 : 0;
    before.assign(result.labels.begin(), result.labels.end());
    std::array<bool, limits::kMaxRegions> now{};
    for (const Region& region : result.regions) now[static_cast<std::size_t>(region.id)] = true;
    for (std::size_t k = 0; k < now.size(); ++k) regions_came += now[k] && !alive[k] ? 1 : 0;
    alive = now;
  }
};

int fail(const std::string& why) {
  std::fprintf(stderr, "follow_sequence: %s\n", why.c_str());
  return 2;
}

int follow(const std::filesystem::path& recording, const std::filesystem::path& out,
           const std::string& without) {
  auto source = open_recording(recording);
  if (!source) return fail(source.error().message);
  const BuiltFromFile model(recording / "model.ply");
  if (!model.good) return fail("no model.ply in " + recording.string());
  TrackSettings settings;
  const struct {
    const char* name;
    bool TrackSteps::*step;
  } steps[] = {{"input_filter", &TrackSteps::input_filter},
               {"temporal_evidence", &TrackSteps::temporal_evidence},
               {"merge_and_split", &TrackSteps::merge_and_split},
               {"robust_weights", &TrackSteps::robust_weights}};
  bool known = without.empty();
  for (const auto& step : steps) {
    if (without != step.name) continue;
    settings.steps.*step.step = false;
    known = true;
  }
  if (!known)
    return fail("unknown step '" + without +
                "'; input_filter, temporal_evidence, merge_and_split and robust_weights are known");

  const ModelView& view = model.view;
  const Intrinsics& camera = (*source)->intrinsics();
  const AlignedBlock block(Tracker::workspace_bytes(view, camera, settings));
  Tracker tracker;
  if (const char* fault = tracker.start(view, camera, (*source)->sensor(), settings, block.bytes))
    return fail(fault);
  FrameClock clock;
  tracker.observe({&FrameClock::done, &clock});

  std::vector<Point3f> places;
  PointsPlyWriter writer(view.positions());
  PlainPlacing plain(view);
  const bool whole = without.empty();
  for (const char* folder : {"warp", "rigid", "radius"})
    if (whole || std::string_view(folder) == "warp") std::filesystem::create_directories(out / folder);
  const auto write = [&](const char* folder, const TrackResult& result, std::span<const Point3f> positions) {
    const std::string path = fmt::format("{}/{}/{:06}.ply", out.string(), folder, result.frame);
    return writer.write(path.c_str(), positions, result.labels, result.matches, result.residuals);
  };

  Changes changes;
  std::vector<double> all, deform, rigid, radius;
  std::int64_t frames = 0;
  SourceItem item;
  for ((*source)->next(1000, item); item.event != SourceEvent::end; (*source)->next(1000, item)) {
    if (item.event != SourceEvent::frame) continue;
    ++frames;
    clock.deform = 0;
    const double start = clock.last = thread_us();
    const TrackResult& result = tracker.process(item.frame);
    const double took = thread_us() - start;
    if (result.state != TrackState::tracking) continue;
    all.push_back(took);
    deform.push_back(clock.deform);
    changes.look(result);
    if (Outcome written = write("warp", result, result.positions); !written)
      return fail(written.error().message);
    if (!whole) continue;
    const double before_rigid = thread_us();
    plain.rigid(result, places);
    rigid.push_back(thread_us() - before_rigid);
    if (Outcome written = write("rigid", result, places); !written) return fail(written.error().message);
    const double before_radius = thread_us();
    plain.radius_search(result, item.frame, camera, kRadius, places);
    radius.push_back(thread_us() - before_radius);
    if (Outcome written = write("radius", result, places); !written) return fail(written.error().message);
  }
  fmt::print(
      "{{\"frames\": {}, \"tracked\": {}, \"region_changes\": {}, \"regions_came\": {}, \"frame_us\": "
      "{:.0f}, "
      "\"warp_us\": {:.0f}, \"rigid_us\": {:.0f}, \"radius_us\": {:.0f}}}\n",
      frames, all.size(), changes.of_points, changes.regions_came, median_of(all), median_of(deform),
      median_of(rigid), median_of(radius));
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: follow_sequence RECORDING OUT [STEP LEFT OUT]\n", stderr);
    return 2;
  }
  return pliant::follow(argv[1], argv[2], argc > 3 ? argv[3] : "");
}

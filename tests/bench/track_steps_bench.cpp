// The steps of a tracked VGA frame on a model of several thousand points.
#include <benchmark/benchmark.h>

#include "tests/core/track_scene.hpp"

namespace pliant {
namespace {

using synthetic::TrackScene;
using synthetic::usual_pose;

TrackScene& scene() {
  static TrackScene one(synthetic::bumpy_body(), 0.0045, {640, 480, 575, 575, 319.5, 239.5, 1000});
  static const bool once = [] {
    one.place(usual_pose());
    one.see_body(usual_pose(), 0.0012);
    return true;
  }();
  (void)once;
  return one;
}

void count_points(benchmark::State& state) {
  state.counters["points"] = static_cast<double>(scene().tables.size);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene().tables.size));
}

SearchReaches all_points() {
  return for_every_region(SearchReach{scene().tables.size, 24 * kUnitsPerMillimetre});
}

void associate_points(benchmark::State& state) {
  TrackScene& s = scene();
  for (auto _ : state) associate(s.tables, s.surface, s.projector, s.regions, all_points(), s.points);
  count_points(state);
}

void align_base(benchmark::State& state) {
  TrackScene& s = scene();
  associate(s.tables, s.surface, s.projector, s.regions, all_points(), s.points);
  AlignSettings settings;
  settings.widest = for_every_region(10 * kUnitsPerMillimetre);
  for (auto _ : state) {
    s.regions[0].pose = usual_pose();
    benchmark::DoNotOptimize(align(s.surface, settings, {}, s.points, s.regions));
  }
  count_points(state);
}

void label_all(benchmark::State& state) {
  TrackScene& s = scene();
  s.regions[0].pose = usual_pose();
  for (auto _ : state) benchmark::DoNotOptimize(s.label_now());
  count_points(state);
}

BENCHMARK(associate_points)->Unit(benchmark::kMicrosecond);
BENCHMARK(align_base)->Unit(benchmark::kMicrosecond);
BENCHMARK(label_all)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pliant

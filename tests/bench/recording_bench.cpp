// Writing a recording: what a VGA frame of the simulated sensor takes of one core, of the 33 ms between two.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/recording/recording_writer.hpp"
#include "drivers/simulated/simulated.hpp"

namespace pliant {
namespace {

constexpr int kFrames = 30;

/// Into the folder for temporary files; the time is the processor's.
void write_frames(benchmark::State& state) {
  auto source = open_simulated("simulated:cushion?frames=" + std::to_string(kFrames));
  if (!source) return state.SkipWithError(source.error().message.c_str());
  const Intrinsics camera = (*source)->intrinsics();
  std::vector<std::vector<std::uint16_t>> pictures;
  SourceItem item;
  for (int i = 0; i < kFrames; ++i) {
    (*source)->next(1000, item);
    pictures.emplace_back(item.frame.depth, item.frame.depth + std::ptrdiff_t{camera.width} * camera.height);
  }
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "pliant_recording_bench";
  std::filesystem::remove_all(folder);
  auto writer = RecordingWriter::create(folder, {camera, {}});
  if (!writer) return state.SkipWithError(writer.error().message.c_str());
  std::int64_t number = 0;
  for (auto _ : state) {
    const auto& picture = pictures[static_cast<std::size_t>(number % kFrames)];
    const DepthFrame frame{picture.data(), camera.width,    camera.height,
                           camera.width,   number * 33'333, number};
    if (const Outcome written = (*writer)->write(frame); !written)
      return state.SkipWithError(written.error().message.c_str());
    ++number;
  }
  state.counters["frames_a_second"] =
      benchmark::Counter(static_cast<double>(number), benchmark::Counter::kIsRate);
  writer->reset();
  std::filesystem::remove_all(folder);
}
BENCHMARK(write_frames)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pliant

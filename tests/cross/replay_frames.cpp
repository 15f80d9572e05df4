// replay_frames MODEL RECORDING [--kernels K] [--frames N]: tracks a recording from memory with the core
// alone and prints a digest of every bit of every result. Two builds that print the same digest compute the
// same. Frames and stages are marked for the instruction counter.
#include <utility>

#include "core/tracker.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/model_file.hpp"
#include "tests/cross/replay.hpp"

namespace {

using namespace pliant;
using namespace pliant::cross;

void add(Digest& digest, const TrackResult& r) {
  digest.add(r.utime);
  digest.add(r.frame);
  digest.add(static_cast<std::uint8_t>(r.state));
  digest.add(r.confidence);
  digest.add(r.pose);
  for (const Region& region : r.regions) {
    digest.add(region.id);
    digest.add(region.parent);
    digest.add(region.points);
    digest.add(region.rms);
    digest.add(region.confidence);
    digest.add(region.pose);
  }
  for (std::size_t i = 0; i < r.labels.size(); ++i) {
    digest.add(r.labels[i]);
    digest.add(r.matches[i]);
    digest.add(r.residuals[i]);
    digest.add(r.positions[i].x);
    digest.add(r.positions[i].y);
    digest.add(r.positions[i].z);
  }
}

/// A model file, or what is built of the simulated object ("-").
Result<ModelFile> model_of(const std::string& path, const std::string& source) {
  if (path != "-") return ModelFile::open(path);
  if (!source.starts_with("simulated:")) return Error{ErrorKind::bad_input, "a recording needs a model"};
  const Result<std::unique_ptr<SimulatedSource>> simulated = open_simulated(source);
  if (!simulated) return simulated.error();
  Result<BuiltModel> built = build_model((*simulated)->mesh(), {});
  if (!built) return built.error();
  return ModelFile::from_image(std::move(built->image), "built");
}

int fail(const std::string& message) {
  std::fprintf(stderr, "replay_frames: %s\n", message.c_str());
  return 2;
}

}  // namespace

int main(int count, char** words) {
  Options options;
  if (count < 3 || !parse(count, words, 3, options))
    return fail(
        "usage: replay_frames MODEL|- RECORDING|simulated:... [--kernels auto|scalar|sse|avx2|neon] "
        "[--frames N]");
  Result<std::unique_ptr<DepthSource>> source = open(words[2]);
  if (!source) return fail(source.error().message);
  const Result<ModelFile> file = model_of(words[1], words[2]);
  if (!file) return fail(file.error().message);
  const ModelView& model = file->view();
  const Intrinsics camera = (*source)->intrinsics();
  const SensorDescription sensor = (*source)->sensor();
  const std::vector<Picture> pictures = pictures_of(**source, options.frames);

  TrackSettings settings;
  settings.kernels = options.kernels;
  const std::size_t bytes = Tracker::workspace_bytes(model, camera, settings);
  const auto block = block_of(bytes);
  if (block == nullptr) return fail("not enough memory");
  Tracker tracker;
  if (const char* fault = tracker.start(model, camera, sensor, settings, {block.get(), bytes}))
    return fail(fault);
  StageObserver observer;
  observer.stage_done = [](void*, Stage stage) { mark(Mark::stage_done, static_cast<long>(stage)); };
  tracker.observe(observer);

  Digest digest;
  for (const std::byte b : file->image()) digest.add(static_cast<unsigned char>(b));
  std::size_t states[3] = {0, 0, 0};
  for (const Picture& picture : pictures) {
    mark(Mark::frame_begins, static_cast<long>(picture.frame.number));
    const TrackResult& result = tracker.process(picture.frame);
    mark(Mark::frame_done, static_cast<long>(result.state));
    add(digest, result);
    ++states[static_cast<std::size_t>(result.state)];
  }
  std::printf("digest %016llx frames %zu tracked %zu searching %zu lost %zu\n", digest.value(),
              pictures.size(), states[1], states[0], states[2]);
  return 0;
}

// replay_frames MODEL RECORDING [--kernels K] [--frames N]: tracks a recording from memory with the core
// alone and prints a digest of every bit of every result. Two builds that print the same digest compute the
// same.
//
// Around every frame, and after every stage of one, it makes a harmless system call with marked arguments, by
// which the instruction counter (count_instructions.c) tells them apart.
#include <sys/syscall.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/memory/workspace.hpp"
#include "core/tracker.hpp"
#include "drivers/model_files/model_builder.hpp"
#include "drivers/model_files/model_file.hpp"
#include "drivers/recording/recording.hpp"
#include "drivers/simulated/simulated.hpp"

namespace {

using namespace pliant;

constexpr long kMark = 0x504C4E54;  // as in count_instructions.c
enum class Mark : long { frame_begins, stage_done, frame_done };

void mark(Mark what, long value) {
  (void)::syscall(SYS_getppid, kMark, static_cast<long>(what), value);
}

/// FNV-1a over bytes.
class Digest {
 public:
  template <typename T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T>);
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char b : bytes) hash_ = (hash_ ^ b) * 1099511628211ULL;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(const RigidTransform& pose) {
    for (int i = 0; i < 9; ++i) add(pose.rotation(i / 3, i % 3));
    for (int i = 0; i < 3; ++i) add(pose.translation[i]);
  }
  void add(const TrackResult& r) {
    add(r.utime);
    add(r.frame);
    add(static_cast<std::uint8_t>(r.state));
    add(r.confidence);
    add(r.pose);
    for (const Region& region : r.regions) {
      add(region.id);
      add(region.parent);
      add(region.points);
      add(region.rms);
      add(region.confidence);
      add(region.pose);
    }
    for (std::size_t i = 0; i < r.labels.size(); ++i) {
      add(r.labels[i]);
      add(r.matches[i]);
      add(r.residuals[i]);
      add(r.positions[i].x);
      add(r.positions[i].y);
      add(r.positions[i].z);
    }
  }
  [[nodiscard]] unsigned long long value() const { return hash_; }

 private:
  std::uint64_t hash_ = 14695981039346656037ULL;
};

struct Options {
  std::string model, source;
  Kernels kernels = Kernels::automatic;
  std::size_t frames = SIZE_MAX;
};

bool parse(int count, char** words, Options& options) {
  if (count < 3) return false;
  options.model = words[1];
  options.source = words[2];
  for (int i = 3; i + 1 < count; i += 2) {
    const std::string name = words[i], value = words[i + 1];
    if (name == "--frames") {
      options.frames = static_cast<std::size_t>(std::atoll(value.c_str()));
    } else if (name == "--kernels") {
      const char* const names[] = {"auto", "scalar", "sse", "avx2", "neon"};
      for (int k = 0; k < 5; ++k)
        if (value == names[k]) options.kernels = static_cast<Kernels>(k);
    } else {
      return false;
    }
  }
  return true;
}

struct Inputs {
  std::unique_ptr<DepthSource> source;
  ModelFile model;
};

Result<Inputs> open(const Options& options) {
  Inputs inputs;
  Result<BuiltModel> built = Error{ErrorKind::bad_input, "a recording needs a model"};
  if (options.source.starts_with("simulated:")) {
    Result<std::unique_ptr<SimulatedSource>> simulated = open_simulated(options.source);
    if (!simulated) return simulated.error();
    if (options.model == "-") built = build_model((*simulated)->mesh(), {});
    inputs.source = std::move(*simulated);
  } else {
    Result<std::unique_ptr<DepthSource>> recording = open_recording(options.source);
    if (!recording) return recording.error();
    inputs.source = std::move(*recording);
  }
  if (options.model == "-" && !built) return built.error();
  Result<ModelFile> model = options.model == "-" ? ModelFile::from_image(std::move(built->image), "built")
                                                 : ModelFile::open(options.model);
  if (!model) return model.error();
  inputs.model = std::move(*model);
  return inputs;
}

int fail(const std::string& message) {
  std::fprintf(stderr, "replay_frames: %s\n", message.c_str());
  return 2;
}

}  // namespace

int main(int count, char** words) {
  Options options;
  if (!parse(count, words, options))
    return fail(
        "usage: replay_frames MODEL|- RECORDING|simulated:... [--kernels auto|scalar|sse|avx2|neon] "
        "[--frames N]");
  Result<Inputs> inputs = open(options);
  if (!inputs) return fail(inputs.error().message);
  const ModelView& model = inputs->model.view();
  DepthSource& source = *inputs->source;

  // All pictures first: decoding is not counted.
  const Intrinsics camera = source.intrinsics();
  const SensorDescription sensor = source.sensor();
  struct Picture {
    std::vector<std::uint16_t> depth;
    DepthFrame frame;
  };
  std::vector<Picture> pictures;
  SourceItem item;
  for (source.next(1000, item); item.event != SourceEvent::end && pictures.size() < options.frames;
       source.next(1000, item)) {
    if (item.event != SourceEvent::frame) continue;
    Picture& p = pictures.emplace_back();
    for (int v = 0; v < item.frame.height; ++v) {
      const std::uint16_t* row = item.frame.depth + static_cast<std::ptrdiff_t>(v) * item.frame.stride;
      p.depth.insert(p.depth.end(), row, row + item.frame.width);
    }
    p.frame = item.frame;
    p.frame.stride = item.frame.width;
    p.frame.depth = p.depth.data();
  }
  source.close();

  TrackSettings settings;
  settings.kernels = options.kernels;
  const std::size_t bytes = Tracker::workspace_bytes(model, camera, settings);
  void* block = std::aligned_alloc(Workspace::kAlignment, (bytes + 63) / 64 * 64);
  if (block == nullptr) return fail("not enough memory");
  Tracker tracker;
  if (const char* fault =
          tracker.start(model, camera, sensor, settings, {static_cast<std::byte*>(block), bytes}))
    return fail(fault);
  StageObserver observer;
  observer.stage_done = [](void*, Stage stage) { mark(Mark::stage_done, static_cast<long>(stage)); };
  tracker.observe(observer);

  Digest digest;
  for (const std::byte b : inputs->model.image()) digest.add(static_cast<unsigned char>(b));
  std::size_t states[3] = {0, 0, 0};
  for (const Picture& picture : pictures) {
    mark(Mark::frame_begins, static_cast<long>(picture.frame.number));
    const TrackResult& result = tracker.process(picture.frame);
    mark(Mark::frame_done, static_cast<long>(result.state));
    digest.add(result);
    ++states[static_cast<std::size_t>(result.state)];
  }
  std::printf("digest %016llx frames %zu tracked %zu searching %zu lost %zu\n", digest.value(),
              pictures.size(), states[1], states[0], states[2]);
  std::free(block);
  return 0;
}

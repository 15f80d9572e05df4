// capture_frames RECORDING [--kernels K] [--frames N]: captures a model from a recording in memory with the
// core alone and prints a digest of every pose and, at the end, of the whole volume. Two builds that print
// the same digest compute the same. Frames are marked for the instruction counter.
#include "core/capture/object_capture.hpp"
#include "tests/cross/replay.hpp"

namespace {

using namespace pliant;
using namespace pliant::cross;

void add(Digest& digest, const DistanceVolume& volume) {
  const int n = volume.plan().cells;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const Voxel& voxel = volume.at(x, y, z);
        digest.add(voxel.distance);
        digest.add(voxel.weight);
      }
}

int fail(const std::string& message) {
  std::fprintf(stderr, "capture_frames: %s\n", message.c_str());
  return 2;
}

}  // namespace

int main(int count, char** words) {
  Options options;
  if (count < 2 || !parse(count, words, 2, options))
    return fail(
        "usage: capture_frames RECORDING|simulated:... [--kernels auto|scalar|sse|avx2|neon] [--frames N]");
  Result<std::unique_ptr<DepthSource>> source = open(words[1]);
  if (!source) return fail(source.error().message);
  const Intrinsics camera = (*source)->intrinsics();
  const SensorDescription sensor = (*source)->sensor();
  const std::vector<Picture> pictures = pictures_of(**source, options.frames);

  CaptureSettings settings;
  settings.kernels = options.kernels;
  const std::size_t bytes = ObjectCapture::workspace_bytes(camera, sensor, settings);
  const auto block = block_of(bytes);
  if (block == nullptr) return fail("not enough memory");
  ObjectCapture capture;
  if (const char* fault = capture.start(camera, sensor, settings, {block.get(), bytes})) return fail(fault);
  Digest digest;
  for (const Picture& picture : pictures) {
    mark(Mark::frame_begins, static_cast<long>(picture.frame.number));
    const CaptureStatus& status = capture.process(picture.frame);
    mark(Mark::frame_done, static_cast<long>(status.state));
    digest.add(static_cast<std::uint8_t>(status.state));
    digest.add(status.pose);
    digest.add(status.agreement);
    digest.add(status.held);
  }
  const JointFit joint = capture.finish();
  digest.add(joint.before);
  digest.add(joint.after);
  add(digest, capture.volume());
  const CaptureFigures& figures = capture.figures();
  std::printf("digest %016llx frames %zu fused %lld lost %lld views %zu\n", digest.value(), pictures.size(),
              static_cast<long long>(figures.fused), static_cast<long long>(figures.lost),
              capture.keyframes().all().size());
  return 0;
}

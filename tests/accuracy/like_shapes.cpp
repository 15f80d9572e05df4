// What is claimed of plain things of about the object's size: like_shapes VIEWS FIRST_SEED TARGET...
// Each view is a Structure Sensor's picture, at 0.5 to 1.2 m before a wall, of a ball, an ellipsoid, a box, a
// cylinder or a plate that has 0.7 to 1.2 times the target's own extents (30 cm across). Both searches look
// at it: that of single pictures, and the tracker's.
#include <cstdio>
#include <cstdlib>

#include "core/detect/frame_detector.hpp"
#include "core/memory/row_major.hpp"
#include "tests/accuracy/plain_shapes.hpp"
#include "tests/accuracy/registration_runs.hpp"
#include "tests/accuracy/view_maker.hpp"
#include "tests/frame_of.hpp"

namespace pliant {
namespace {

/// The search as `pliant register` does it, or the tracker.
struct ReadyDetector {
  ReadyDetector(const ModelView& model, const Intrinsics& camera, bool single) : block(0) {
    DetectSettings settings;
    if (single) {
      settings.rounds = 5;
      settings.thorough = true;
      settings.matches = 3;
      settings.model_keypoints = 2048;
    }
    Workspace measure;
    lay_out(measure, model, camera, settings);
    block = AlignedBlock(measure.used());
    Workspace workspace(block.bytes);
    lay_out(workspace, model, camera, settings);
    surface.start(camera, SensorDescription());
    detector.start(model, camera, SensorDescription(), Kernels::automatic);
  }
  void lay_out(Workspace& workspace, const ModelView& model, const Intrinsics& camera,
               const DetectSettings& settings) {
    surface.lay_out(workspace, camera);
    detector.lay_out(workspace, model, camera, settings);
  }
  const Detection& look(const DepthFrame& frame) {
    surface.build(frame, {0, 0, frame.width, frame.height});
    detector.begin(surface);
    while (detector.step(100000) == DetectState::working) {
    }
    return detector.best();
  }
  AlignedBlock block;
  Surface surface;
  FrameDetector detector;
};

int look(int argc, char** argv) {
  const int views = std::max(1, std::atoi(argv[1]));
  const std::uint64_t first = std::strtoull(argv[2], nullptr, 10);
  const Intrinsics camera = structure_camera();
  simulated::DisparityImage image(camera);
  for (int k = 3; k < argc; ++k) {
    const Result<Geometry> file = read_geometry(argv[k]);
    if (!file) {
      std::fprintf(stderr, "like_shapes: %s\n", file.error().message.c_str());
      return 2;
    }
    const ScaledMesh target = scaled(*file, kSize);
    const BuiltFromFile model(geometry_of(target));
    if (!model.good) {
      std::fprintf(stderr, "like_shapes: %s makes no model\n", argv[k]);
      return 2;
    }
    ReadyDetector single(model.view, camera, true), tracker(model.view, camera, false);
    for (const PlainShape shape : kPlainShapes) {
      int claims[2] = {0, 0};
      for (int n = 0; n < views; ++n) {
        const std::uint64_t seed = first + static_cast<std::uint64_t>(n);
        const std::vector<std::uint16_t> picture = picture_like(target, shape, seed, image);
        for (ReadyDetector* one : {&single, &tracker}) {
          const Detection& d = one->look(test::frame_of(picture, camera));
          const bool found = one->detector.state() == DetectState::found;
          claims[one == &single ? 0 : 1] += found ? 1 : 0;
          if (found)
            std::printf("%s, %s, seed %llu: claimed, score %.2f\n", name_of(shape),
                        one == &single ? "single" : "tracker", static_cast<unsigned long long>(seed),
                        d.score);
        }
      }
      std::printf("| %s | %s | %d of %d | %d of %d |\n", std::filesystem::path(argv[k]).stem().c_str(),
                  name_of(shape), claims[0], views, claims[1], views);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace
}  // namespace pliant

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("usage: like_shapes VIEWS FIRST_SEED TARGET...\n", stderr);
    return 2;
  }
  return pliant::look(argc, argv);
}

#include "firmware-app/commands/one_shot_detector.hpp"

namespace pliant {

Result<std::unique_ptr<OneShotDetector>> OneShotDetector::create(const ModelView& model,
                                                                 const Intrinsics& camera,
                                                                 const SensorDescription& sensor) {
  std::unique_ptr<OneShotDetector> made(new OneShotDetector());
  const auto lay_out = [&](Workspace& workspace) {
    made->surface_.lay_out(workspace, camera);
    made->detector_.lay_out(workspace, model, camera, {});
  };
  Workspace measuring;
  lay_out(measuring);
  Result<MemoryBlock> block = MemoryBlock::allocate(measuring.used());
  if (!block) return block.error();
  made->block_ = std::move(*block);
  Workspace workspace(made->block_.bytes());
  lay_out(workspace);
  made->surface_.start(camera, sensor);
  made->detector_.start(model, camera, sensor, Kernels::automatic);
  return made;
}

bool OneShotDetector::look(const DepthFrame& frame) {
  surface_.build(frame, {0, 0, frame.width, frame.height});
  detector_.begin(surface_);
  while (detector_.step(1 << 20) == DetectState::working) {
  }
  return detector_.state() == DetectState::found;
}

}  // namespace pliant

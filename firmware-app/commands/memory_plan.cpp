#include "firmware-app/commands/memory_plan.hpp"

#include <fmt/format.h>

#include "core/tracker.hpp"
#include "drivers/lcm/publisher.hpp"
#include "firmware-app/pipeline/frame_ring.hpp"
#include "firmware-app/pipeline/memory_block.hpp"

namespace pliant {

MemoryPlan plan_memory(const ModelFile& model, const Intrinsics& camera, const TrackSettings& settings) {
  const std::size_t points = model.view().size();
  MemoryPlan plan;
  plan.workspace = Tracker::workspace_bytes(model.view(), camera, settings);
  plan.model = model.image().size();
  plan.frames = FrameRing::bytes(camera);
  // One set of buffers to encode into, and the publisher's slots.
  plan.messages = TrackMessages::max_bytes(points) * (1 + LcmPublisher::kFrameSlots);
  return plan;
}

Outcome check_tracker(const ModelFile& model, const Intrinsics& camera, const SensorDescription& sensor,
                      const TrackSettings& settings) {
  Result<MemoryBlock> block = MemoryBlock::allocate(Tracker::workspace_bytes(model.view(), camera, settings));
  if (!block) return block.error();
  Tracker tracker;
  const char* const fault = tracker.start(model.view(), camera, sensor, settings, block->bytes());
  if (fault == nullptr) return success();
  return Error{ErrorKind::bad_input, fmt::format("the tracker cannot start: {}", fault)};
}

std::string describe(const MemoryPlan& plan) {
  const auto megabytes = [](std::size_t bytes) { return static_cast<double>(bytes) / 1e6; };
  return fmt::format("{:.1f} (workspace {:.1f}, model {:.1f}, frames {:.1f}, messages {:.1f})",
                     megabytes(plan.total()), megabytes(plan.workspace), megabytes(plan.model),
                     megabytes(plan.frames), megabytes(plan.messages));
}

}  // namespace pliant

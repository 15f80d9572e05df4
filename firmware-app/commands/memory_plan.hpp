// The memory that a run will take, before it runs.
#pragma once

#include <cstddef>
#include <string>

#include "core/camera/intrinsics.hpp"
#include "core/camera/sensor.hpp"
#include "core/track_settings.hpp"
#include "drivers/common/result.hpp"
#include "drivers/model_files/model_file.hpp"

namespace pliant {

struct MemoryPlan {
  std::size_t workspace = 0;  ///< the tracker's block
  std::size_t model = 0;      ///< the mapped model
  std::size_t frames = 0;     ///< ring between capture and tracking
  std::size_t messages = 0;   ///< buffers of the publisher

  [[nodiscard]] std::size_t total() const { return workspace + model + frames + messages; }
};

[[nodiscard]] MemoryPlan plan_memory(const ModelFile& model, const Intrinsics& camera,
                                     const TrackSettings& settings);
/// Whether a tracker starts with these, tried with the memory that it takes; the words are those of a run.
[[nodiscard]] Outcome check_tracker(const ModelFile& model, const Intrinsics& camera,
                                    const SensorDescription& sensor, const TrackSettings& settings);
/// "13.2 (workspace 9.1, model 0.9, frames 2.5, messages 0.7)", MB.
[[nodiscard]] std::string describe(const MemoryPlan& plan);

}  // namespace pliant

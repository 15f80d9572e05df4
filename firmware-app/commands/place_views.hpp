// Views from far apart, of unknown poses, brought together.
#pragma once

#include <functional>
#include <vector>

#include "core/capture/object_capture.hpp"
#include "drivers/depth_source/depth_source.hpp"

namespace pliant {

/// Puts the views into `capture`, which was started for them (CaptureSettings::separate_views): the first in
/// which an object stands makes the model's frame; the others are found by the tracker's own detection of
/// what is known of the object so far, are aligned, and taken where nearly all of them fits, until none is
/// left that does, or StopSignal is requested. `tell` is given how many are placed after each. Returns the
/// positions of those that could not be placed.
[[nodiscard]] Result<std::vector<std::size_t>> place_views(const std::vector<DepthFrame>& views,
                                                           const Intrinsics& camera,
                                                           const SensorDescription& sensor,
                                                           ObjectCapture& capture,
                                                           const std::function<void(std::size_t)>& tell);

}  // namespace pliant

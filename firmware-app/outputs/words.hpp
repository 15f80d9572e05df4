// The words for the states of tracking, the same everywhere; those of devices:
// drivers/depth_source/device_state.hpp.
#pragma once

#include "drivers/lcm/messages.hpp"

namespace pliant {

[[nodiscard]] constexpr const char* state_word(TrackState state) {
  switch (state) {
    case TrackState::searching:
      return "searching";
    case TrackState::tracking:
      return "tracking";
    case TrackState::lost:
      return "lost";
  }
  return "unknown";
}

}  // namespace pliant

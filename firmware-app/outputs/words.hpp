// The words for states, the same everywhere.
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

[[nodiscard]] constexpr const char* device_word(DeviceState state) {
  switch (state) {
    case DeviceState::absent:
      return "absent";
    case DeviceState::opening:
      return "opening";
    case DeviceState::streaming:
      return "streaming";
    case DeviceState::stalled:
      return "stalled";
    case DeviceState::lost:
      return "lost";
    case DeviceState::reopening:
      return "reopening";
    case DeviceState::ended:
      return "ended";
  }
  return "unknown";
}

}  // namespace pliant

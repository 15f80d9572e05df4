// The words for a depth device's state.
#pragma once

#include "drivers/lcm/messages.hpp"

namespace pliant {

[[nodiscard]] constexpr const char* device_word(DeviceState state) {
  switch (state) {
    case DeviceState::closed:
      return "closed";
    case DeviceState::opening:
      return "opening";
    case DeviceState::streaming:
      return "streaming";
    case DeviceState::silent:
      return "silent";
    case DeviceState::reconnecting:
      return "reconnecting";
    case DeviceState::ended:
      return "ended";
    case DeviceState::lost:
      return "lost";
  }
  return "unknown";
}

}  // namespace pliant
